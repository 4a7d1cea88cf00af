#include "host/scene/pin_meetings.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include <fmt/format.h>

#include "host/solver/contact/pin_paths.hpp"

namespace selvage {
namespace {

constexpr int most_looks = 4000;      // at the held vertices on their way
constexpr int fine_looks = 40;        // around a time at which two of them are near
constexpr double neighbours = 1.5;    // edge lengths: vertices that start so near are beside each other
constexpr double near_enough = 0.55;  // of an edge: edges that meet have ends nearer than that
constexpr double worth_a_look = 1.5;  // edge lengths: what is further apart at one look does not meet before the next
constexpr double way_between_looks = 0.5;  // of an edge

// The held vertices and where they are at a time.
class HeldVertices {
public:
    HeldVertices(const Cloth& cloth) : cloth_(cloth), topology_(make_topology(cloth, true)), paths_(cloth, topology_) {}
    const PinPaths& paths() const { return paths_; }

    // One vertex for each held particle.
    std::map<int, Vec3> places(double time) const
    {
        std::map<int, Vec3> places, moved;
        for (const auto& [particle, x] : paths_.places(time)) moved[particle] = x;
        std::map<int, int> seen;
        for (const int v : cloth_.pinned) {
            const int particle = topology_.particle_of[v];
            if (!seen.try_emplace(particle, v).second) continue;
            const auto at = moved.find(particle);
            places[v] = at == moved.end() ? cloth_.positions[v] : at->second;
        }
        return places;
    }

private:
    const Cloth& cloth_;
    const Topology topology_;
    const PinPaths paths_;
};

struct Meeting {
    int a = 0, b = 0;
    double time = 0, distance = 0;  // [s], [m]
};

std::array<long, 3> cell_of(const Vec3& x, double size)
{
    return {std::lround(std::floor(x.x() / size)), std::lround(std::floor(x.y() / size)),
            std::lround(std::floor(x.z() / size))};
}

// Pairs nearer than `reach` that started further apart.
std::vector<std::array<int, 2>> near_pairs(const std::map<int, Vec3>& places, const std::map<int, Vec3>& start,
                                           double reach, double least_start)
{
    std::map<std::array<long, 3>, std::vector<int>> cells;
    std::vector<std::array<int, 2>> pairs;
    for (const auto& [v, x] : places) {
        const auto cell = cell_of(x, reach);
        for (long i = -1; i <= 1; ++i)
            for (long j = -1; j <= 1; ++j)
                for (long k = -1; k <= 1; ++k) {
                    const auto found = cells.find({cell[0] + i, cell[1] + j, cell[2] + k});
                    if (found == cells.end()) continue;
                    for (const int other : found->second)
                        if ((places.at(other) - x).norm() < reach &&
                            (start.at(other) - start.at(v)).norm() > least_start)
                            pairs.push_back({other, v});
                }
        cells[cell].push_back(v);
    }
    return pairs;
}

// The nearest of some pairs in a part of the way.
Meeting nearest_of(const HeldVertices& held, const std::vector<std::array<int, 2>>& pairs, double time, double dt)
{
    Meeting nearest{0, 0, 0, std::numeric_limits<double>::infinity()};
    for (int k = 0; k <= fine_looks && !pairs.empty(); ++k) {
        const double at = time + dt * k / fine_looks;
        const std::map<int, Vec3> places = held.places(at);
        for (const auto& [a, b] : pairs) {
            const double distance = (places.at(a) - places.at(b)).norm();
            if (distance < nearest.distance) nearest = {a, b, at, distance};
        }
    }
    return nearest;
}

// The first pair that comes nearer than `reach`, when it is nearest.
std::optional<Meeting> first_meeting(const HeldVertices& held, double end, double edge, double reach)
{
    const std::map<int, Vec3> start = held.places(0);
    std::optional<Meeting> met;
    double time = 0;
    for (int look = 0; look < most_looks && time < end; ++look) {
        const double dt = held.paths().longest_step(time, end - time, way_between_looks * edge);
        const auto pairs = met ? std::vector<std::array<int, 2>>{{met->a, met->b}}
                               : near_pairs(held.places(time + dt), start, worth_a_look * edge, neighbours * edge);
        const Meeting nearest = nearest_of(held, pairs, time, dt);
        if (met && !(nearest.distance < met->distance)) return met;
        if (nearest.distance < reach) met = nearest;
        time += dt;
    }
    return met;
}

std::string vertex_name(const Cloth& cloth, int vertex)
{
    for (const ClothPanel& panel : cloth.panels)
        if (vertex < panel.first_vertex + panel.vertex_count)
            return fmt::format("{} of {}", vertex - panel.first_vertex, panel.name);
    return std::to_string(vertex);
}

}  // namespace

std::optional<Finding> find_meeting_pins(const Cloth& cloth, const Scene& scene)
{
    if (cloth.pin_motions.empty() || !scene.contact.self) return {};
    const HeldVertices held(cloth);
    const double end =
        scene.until().equilibrium ? held.paths().end() : std::min(held.paths().end(), scene.until().time);
    const double edge = typical_edge(cloth), reach = std::max(scene.contact.gap, near_enough * edge);
    const std::optional<Meeting> meeting = first_meeting(held, end, edge, std::min(reach, worth_a_look * edge));
    if (!meeting) return {};
    Finding finding;
    finding.kind = "pins";
    finding.place = scene.place("pins.motion[0]");
    finding.text = fmt::format("held vertices {} and {} are driven against each other: {:.1f} mm apart at {:.3g} s",
                               vertex_name(cloth, meeting->a), vertex_name(cloth, meeting->b), 1000 * meeting->distance,
                               meeting->time);
    finding.way_on = "end the motion earlier (pins.motion.end), or let them pass beside each other";
    return finding;
}

}  // namespace selvage
