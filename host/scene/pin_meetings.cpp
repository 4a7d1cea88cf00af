#include "host/scene/pin_meetings.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <numeric>
#include <set>
#include <span>
#include <tuple>

#include <fmt/format.h>
#include <Eigen/Geometry>

#include "host/collision/ccd.hpp"
#include "host/model/body_motion.hpp"
#include "host/model/cloth_place.hpp"
#include "host/solver/contact/pin_paths.hpp"

namespace selvage {
namespace {

constexpr double most_work = 5e7;          // places and distances that are computed: about 2 s
constexpr double work_of_a_visit = 0.1;    // to a pair that is far apart, against one whose distance is computed
constexpr double most_work_to_widen = 30;  // for each part: longer ways look at more pairs
constexpr int fewest_fine_looks = 40;      // at pairs that are near
constexpr int most_fine_looks = 400;       // the same
constexpr double neighbours = 1.5;         // edge lengths: what starts so near is beside each other
constexpr double way_between_looks = 0.5;  // of an edge, where something is near
constexpr double forever = std::numeric_limits<double>::infinity();

// A held vertex, or an edge or a face whose corners are all held.
struct Part {
    std::array<int, 3> corners{};  // indices of held vertices
    int count = 1;
    int rigid = -1;  // what moves with it at every time has the same number; -1: its corners do not move alike
};

// The held vertices, one for each particle, and where they are at a time.
class HeldVertices {
public:
    HeldVertices(const Cloth& cloth) : cloth_(cloth), topology_(make_topology(cloth, true)), paths_(cloth, topology_)
    {
        for (const int v : cloth.pinned)
            if (held_of_.try_emplace(topology_.particle_of[v], int(vertices_.size())).second) {
                vertices_.push_back(v);
                start_.push_back(cloth.positions[v]);
            }
        for (const auto& [particle, x] : paths_.places(0)) moving_.push_back(held_of_.at(particle));
        std::vector<std::set<int>> motions(vertices_.size());
        for (int m = 0; m < int(cloth.pin_motions.size()); ++m)
            for (const int v : cloth.pin_motions[m].vertices) motions[held_of_.at(topology_.particle_of[v])].insert(m);
        std::map<std::set<int>, int> number_of;
        for (const std::set<int>& own : motions)
            rigid_.push_back(number_of.try_emplace(own, int(number_of.size())).first->second);
        bodies_ = int(number_of.size());
        for (const int h : moving_) set_speeds(h, motions[h]);
    }

    int count() const { return int(vertices_.size()); }
    int vertex(int held) const { return vertices_[held]; }
    int rigid_bodies() const { return bodies_; }
    double end() const { return paths_.end(); }

    std::vector<Vec3> places(double time) const
    {
        std::vector<Vec3> x = start_;
        const auto moved = paths_.places(time);
        for (std::size_t k = 0; k < moved.size(); ++k) x[moving_[k]] = moved[k].second;
        return x;
    }

    // An upper bound of how fast one of them moves from a time on until the next motion begins or ends [m/s].
    double speed(double time) const
    {
        double fastest = 0;
        for (const auto& own : speeds_) {
            double sum = 0;
            for (const auto& [m, speed] : own)
                if (cloth_.pin_motions[m].start <= time && time < cloth_.pin_motions[m].end) sum += speed;
            fastest = std::max(fastest, sum);
        }
        return fastest;
    }

    double next_change(double time) const
    {
        double next = forever;
        for (const PinMotion& motion : cloth_.pin_motions)
            for (const double at : {motion.start, motion.end})
                if (at > time) next = std::min(next, at);
        return next;
    }

    std::vector<Part> parts() const
    {
        std::set<std::array<int, 3>> corners;  // edges have the second twice, so that they stand once
        std::vector<Part> parts;
        for (int h = 0; h < count(); ++h) parts.push_back({{h, h, h}, 1, rigid_[h]});
        for (const Face& face : cloth_.faces) {
            std::array<int, 3> held;
            for (int k = 0; k < 3; ++k) {
                const auto found = held_of_.find(topology_.particle_of[face[k]]);
                held[k] = found == held_of_.end() ? -1 : found->second;
            }
            for (int k = 0; k < 3; ++k) {
                const int a = std::min(held[k], held[(k + 1) % 3]), b = std::max(held[k], held[(k + 1) % 3]);
                if (a >= 0 && a != b && corners.insert({a, b, b}).second) add(parts, {a, b, b}, 2);
            }
            std::sort(held.begin(), held.end());
            if (held[0] >= 0 && held[0] != held[1] && held[1] != held[2]) add(parts, held, 3);
        }
        return parts;
    }

private:
    void add(std::vector<Part>& parts, const std::array<int, 3>& corners, int count) const
    {
        const int rigid = rigid_[corners[0]];
        const bool alike = rigid_[corners[1]] == rigid && rigid_[corners[2]] == rigid;
        parts.push_back({corners, count, alike ? rigid : -1});
    }

    // How fast each of its motions moves a vertex at most. Motions before may have taken it away from the axis.
    void set_speeds(int held, const std::set<int>& motions)
    {
        auto& own = speeds_.emplace_back();
        double moved = 0;
        for (const int m : motions) {
            const PinMotion& motion = cloth_.pin_motions[m];
            const double turn = 2 * std::numbers::pi * std::abs(motion.turns), span = motion.end - motion.start;
            const double radius = motion.axis.cross(start_[held] - motion.point).norm() + moved;
            own.push_back({m, motion.velocity.norm() + turn * radius / span});
            moved += motion.velocity.norm() * span + std::min(turn, 2.0) * radius;
        }
    }

    const Cloth& cloth_;
    const Topology topology_;
    const PinPaths paths_;
    std::map<int, int> held_of_;  // by particle
    std::vector<int> vertices_, moving_, rigid_;
    std::vector<Vec3> start_;
    std::vector<std::vector<std::pair<int, double>>> speeds_;  // of those that move: motion and speed [m/s]
    int bodies_ = 0;
};

struct Meeting {
    Part a, b;
    double time = 0, distance = forever;  // [s], [m]
};

double distance_to_line(const Vec3& x, const Vec3& a, const Vec3& b)
{
    const Vec3 along = b - a;
    const double squared = along.squaredNorm();
    const double t = squared > 0 ? std::clamp((x - a).dot(along) / squared, 0.0, 1.0) : 0;
    return (x - a - t * along).norm();
}

// Infinite for an edge and a face, and for two faces: where these meet, two edges do or a vertex and a face.
double distance_of(const Part& one, const Part& two, const std::vector<Vec3>& x)
{
    const Part &a = one.count <= two.count ? one : two, &b = one.count <= two.count ? two : one;
    const Vec3 &p = x[a.corners[0]], &q = x[b.corners[0]];
    if (a.count == 1 && b.count == 1) return (p - q).norm();
    if (a.count == 1 && b.count == 2) return distance_to_line(p, q, x[b.corners[1]]);
    if (a.count == 1) return pair_distance({p, q, x[b.corners[1]], x[b.corners[2]]}, false);
    if (b.count == 2) return pair_distance({p, x[a.corners[1]], q, x[b.corners[1]]}, true);
    return forever;
}

// A part's middle in a grid of cells.
struct Placed {
    int rigid = -1;  // as Part::rigid
    std::array<double, 3> cell;
    int part = 0;
    Vec3 middle;
    double radius = 0;  // [m]
    bool operator<(const Placed& o) const { return std::tie(rigid, cell, part) < std::tie(o.rigid, o.cell, o.part); }
};

// Parts that move alike, side by side in a list.
struct Together {
    int rigid = -1;
    std::span<const Placed> parts;
    Box box;  // of their middles
};

std::vector<Together> groups_of(const std::vector<Placed>& sorted)
{
    std::vector<Together> groups;
    for (auto first = sorted.begin(); first != sorted.end();) {
        const auto end = std::find_if(first, sorted.end(), [&](const Placed& p) { return p.rigid != first->rigid; });
        groups.push_back({first->rigid, {first, end}, {}});
        for (; first != end; ++first) groups.back().box.extend(first->middle);
    }
    return groups;
}

class MeetingSearch {
public:
    MeetingSearch(const HeldVertices& held, double edge, double reach)
        : held_(held), parts_(held.parts()), start_(held.places(0)), edge_(edge), reach_(reach)
    {
    }

    double looked_until() const { return time_; }

    // The first pair that comes nearer than the reach, when it is nearest.
    std::optional<Meeting> first(double end)
    {
        std::optional<Meeting> met;
        const double least = way_between_looks * edge_;
        double way = least;
        while (time_ < end) {
            const double speed = held_.speed(time_), room = std::min(held_.next_change(time_), end) - time_;
            const double dt = speed > 0 ? std::min(way / speed, room) : room;
            const double before = work_;
            if (!met) pairs_ = speed > 0 ? near_pairs(held_.places(time_ + 0.5 * dt), reach_ + way) : Pairs();
            const bool lightly = work_ - before < most_work_to_widen * double(parts_.size());
            if (!met && !pairs_.empty() && way > least) {
                way = std::max(least, 0.5 * way);
                continue;
            }
            const Meeting nearest = nearest_pair(dt, way);
            if (met && !(nearest.distance < met->distance)) return met;
            if (nearest.distance < reach_) {
                met = nearest;
                pairs_ = {{met->a, met->b}};
            }
            if (work_ > most_work) return met;
            if (pairs_.empty() && lightly) way *= 2;
            time_ += dt;
        }
        return met;
    }

private:
    using Pairs = std::vector<std::array<Part, 2>>;

    std::vector<Placed> sorted_parts(const std::vector<Vec3>& x, double distance, double& cell_size) const
    {
        std::vector<Placed> placed(parts_.size());
        double largest = 0;
        for (std::size_t k = 0; k < parts_.size(); ++k) {
            const auto& c = parts_[k].corners;
            const Vec3 middle =
                parts_[k].count == 2 ? Vec3(0.5 * (x[c[0]] + x[c[1]])) : (x[c[0]] + x[c[1]] + x[c[2]]) / 3;
            placed[k] = {parts_[k].rigid, {}, int(k), middle};
            for (const int corner : c) placed[k].radius = std::max(placed[k].radius, (x[corner] - middle).norm());
            largest = std::max(largest, placed[k].radius);
        }
        cell_size = 1.01 * (distance + 2 * largest);  // above the distance, for rounding
        for (Placed& part : placed)
            for (int c = 0; c < 3; ++c) part.cell[c] = std::floor(part.middle[c] / cell_size);
        std::sort(placed.begin(), placed.end());
        return placed;
    }

    // Pairs nearer than a distance that started apart and do not move together. Not all of them once the work is done.
    Pairs near_pairs(const std::vector<Vec3>& x, double distance)
    {
        double size = 0;
        const std::vector<Placed> placed = sorted_parts(x, distance, size);
        work_ += double(placed.size());
        Pairs pairs;
        const std::vector<Together> groups = groups_of(placed);
        for (const Placed& a : placed)
            for (const Together& group : groups) {
                if (group.rigid < a.rigid || (group.rigid == a.rigid && a.rigid >= 0)) continue;
                if (group.box.exteriorDistance(a.middle) > size) continue;
                if (work_ > most_work) return pairs;
                add_near_pairs(a, group, x, distance, pairs);
            }
        return pairs;
    }

    void add_near_pairs(const Placed& a, const Together& group, const std::vector<Vec3>& x, double distance,
                        Pairs& pairs)
    {
        work_ += 1;
        for (int column = 0; column < 9; ++column) {
            const double i = a.cell[0] + column % 3 - 1, j = a.cell[1] + column / 3 - 1, k = a.cell[2];
            const Placed lowest{group.rigid, {i, j, k - 1}, -1, Vec3::Zero()};
            for (auto b = std::lower_bound(group.parts.begin(), group.parts.end(), lowest);
                 b != group.parts.end() && b->cell[0] == i && b->cell[1] == j && b->cell[2] <= k + 1; ++b) {
                work_ += work_of_a_visit;
                if (group.rigid == a.rigid && b->part <= a.part) continue;
                if ((a.middle - b->middle).norm() > distance + a.radius + b->radius) continue;
                work_ += 1;
                const Part &one = parts_[a.part], &two = parts_[b->part];
                if (distance_of(one, two, x) < distance && distance_of(one, two, start_) > neighbours * edge_)
                    pairs.push_back({one, two});
            }
        }
    }

    // The nearest pair within a time from now on in which nothing moves further than a way [m].
    Meeting nearest_pair(double dt, double way)
    {
        Meeting nearest;
        if (pairs_.empty()) return nearest;
        // Between two looks nothing comes nearer by more than the reach.
        const int looks =
            int(std::clamp(std::ceil(2 * way / reach_), double(fewest_fine_looks), double(most_fine_looks)));
        const double nearer = 2 * way / looks;  // by one look
        std::vector<int> next(pairs_.size());   // look before which a pair cannot come nearer than the reach
        for (int k = 0; k <= looks && work_ <= most_work; ++k) {
            const double at = time_ + dt * k / looks;
            const std::vector<Vec3> x = held_.places(at);
            work_ += double(held_.count());
            for (std::size_t p = 0; p < pairs_.size(); ++p) {
                if (next[p] > k) continue;
                const auto& [a, b] = pairs_[p];
                const double distance = distance_of(a, b, x);
                work_ += 1;
                next[p] = k + std::max(1, int(std::min((distance - reach_) / nearer, double(looks))));
                if (distance < nearest.distance) nearest = {a, b, at, distance};
            }
        }
        return nearest;
    }

    const HeldVertices& held_;
    const std::vector<Part> parts_;
    const std::vector<Vec3> start_;
    const double edge_, reach_;  // [m]
    Pairs pairs_;
    double time_ = 0, work_ = 0;
};

// The corners of two parts that are nearest to each other.
std::array<int, 2> nearest_corners(const Meeting& meeting, const HeldVertices& held)
{
    const std::vector<Vec3> x = held.places(meeting.time);
    std::array<int, 2> nearest{meeting.a.corners[0], meeting.b.corners[0]};
    for (const int a : meeting.a.corners)
        for (const int b : meeting.b.corners)
            if ((x[a] - x[b]).norm() < (x[nearest[0]] - x[nearest[1]]).norm()) nearest = {a, b};
    return {held.vertex(nearest[0]), held.vertex(nearest[1])};
}

std::string vertex_name(const Cloth& cloth, int vertex)
{
    const ClothPanel& panel = panel_of_vertex(cloth, vertex);
    return fmt::format("{} of {}", vertex - panel.first_vertex, panel.name);
}

}  // namespace

std::optional<Finding> find_meeting_pins(const Cloth& cloth, const Scene& scene, double gap)
{
    if (cloth.pin_motions.empty() || !scene.contact.self) return {};
    const HeldVertices held(cloth);
    if (held.rigid_bodies() < 2) return {};
    const double end = scene.until().equilibrium ? held.end() : std::min(held.end(), scene.until().time);
    MeetingSearch search(held, typical_edge(cloth), gap);
    const std::optional<Meeting> meeting = search.first(end);
    if (!meeting && !(search.looked_until() < end)) return {};
    Finding finding;
    finding.kind = "pins";
    finding.place = scene.place("pins.motion[0]");
    if (!meeting) {
        finding.text = fmt::format(
            "whether held vertices are driven against each other is known until {:.3g} s only: "
            "the ways of all of them are too long to be followed",
            search.looked_until());
        finding.severity = Severity::note;
        return finding;
    }
    const auto [a, b] = nearest_corners(*meeting, held);
    finding.text = fmt::format("held vertices {} and {} are driven against each other: {:.1f} mm apart at {:.3g} s",
                               vertex_name(cloth, a), vertex_name(cloth, b), 1000 * meeting->distance, meeting->time);
    finding.way_on = "end the motion earlier (pins.motion.end), or let them pass beside each other";
    return finding;
}

}  // namespace selvage
