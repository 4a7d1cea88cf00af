#include "host/solver/cloth_contact.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include <tbb/parallel_sort.h>

#include "host/solver/launch.hpp"

namespace selvage {
namespace {

constexpr double keep = 0.1;             // part of a pair's distance that a move leaves
constexpr double slack_of_edge = 0.15;   // slack of the tree's boxes, of an edge length
constexpr int rounds = 4;                // of holding vertices back before the whole move is scaled
constexpr double parallel_sine = 0.1;    // edges that cross at a smaller sine count less

float rounded_up(double x) { return std::nextafter(float(x), std::numeric_limits<float>::infinity()); }
float rounded_down(double x) { return std::nextafter(float(x), 0.0f); }

double typical_edge(const Cloth& cloth)
{
    double total = 0;
    for (const Face& f : cloth.faces) total += (cloth.panel_coordinates[f[0]] - cloth.panel_coordinates[f[1]]).norm();
    return total / std::max<double>(1, double(cloth.faces.size()));
}

// Which way a corner turns tells whether an outline is convex; panels without outline edges here are sheets of a mesh.
bool is_convex(const Cloth& cloth, const ClothPanel& panel)
{
    double area = 0;
    std::vector<Vec2> points(cloth.panel_coordinates.begin() + panel.first_vertex,
                             cloth.panel_coordinates.begin() + panel.first_vertex + panel.vertex_count);
    for (int f = panel.first_face; f < panel.first_face + panel.face_count; ++f) {
        const Vec2 a = cloth.panel_coordinates[cloth.faces[f][1]] - cloth.panel_coordinates[cloth.faces[f][0]];
        const Vec2 b = cloth.panel_coordinates[cloth.faces[f][2]] - cloth.panel_coordinates[cloth.faces[f][0]];
        area += 0.5 * (a.x() * b.y() - a.y() * b.x());
    }
    // A panel is convex if it fills its convex hull.
    std::sort(points.begin(), points.end(), [](const Vec2& a, const Vec2& b) { return std::pair(a.x(), a.y()) < std::pair(b.x(), b.y()); });
    std::vector<Vec2> hull;
    for (int side = 0; side < 2; ++side) {
        const std::size_t base = hull.size();
        for (const Vec2& p : points) {
            const auto turns_right = [&] {
                const Vec2 a = hull.back() - hull[hull.size() - 2], b = p - hull.back();
                return a.x() * b.y() - a.y() * b.x() <= 0;
            };
            while (hull.size() >= base + 2 && turns_right()) hull.pop_back();
            hull.push_back(p);
        }
        hull.pop_back();
        std::reverse(points.begin(), points.end());
    }
    double hull_area = 0;
    for (std::size_t k = 0; k < hull.size(); ++k) {
        const Vec2 &a = hull[k], &b = hull[(k + 1) % hull.size()];
        hull_area += 0.5 * (a.x() * b.y() - a.y() * b.x());
    }
    return area >= (1 - 1e-9) * hull_area;
}

}  // namespace

TreeSurface tree_surface(const Topology& topology, const Cloth& cloth)
{
    TreeSurface surface;
    surface.faces = topology.faces;
    for (const Face& f : cloth.faces)
        surface.rest.push_back({cloth.panel_coordinates[f[0]], cloth.panel_coordinates[f[1]], cloth.panel_coordinates[f[2]]});
    for (const ClothPanel& panel : cloth.panels)
        surface.patches.push_back({panel.first_face, panel.face_count, true, is_convex(cloth, panel)});
    surface.group_of.resize(std::size_t(topology.particle_count));
    std::iota(surface.group_of.begin(), surface.group_of.end(), 0);
    // Vertices that are about to be sewn together must be free to meet.
    const Topology joined = make_topology(cloth, true);
    for (std::size_t v = 0; v < cloth.positions.size(); ++v)
        surface.group_of[topology.particle_of[v]] = joined.particle_of[v];
    return surface;
}

ClothContact::ClothContact(const Topology& topology, const Cloth& cloth, double gap, std::vector<double> friction)
    : gap_(gap), friction_(std::move(friction)), area_(std::size_t(topology.particle_count)),
      tree_(tree_surface(topology, cloth), slack_of_edge * typical_edge(cloth))
{
    for (std::size_t f = 0; f < cloth.faces.size(); ++f) {
        const Face& c = cloth.faces[f];
        const Vec2 a = cloth.panel_coordinates[c[1]] - cloth.panel_coordinates[c[0]];
        const Vec2 b = cloth.panel_coordinates[c[2]] - cloth.panel_coordinates[c[0]];
        for (int particle : topology.faces[f]) area_[particle] += std::abs(a.x() * b.y() - a.y() * b.x()) / 6;
    }
}

PairCorners ClothContact::corners_at(const PairCandidate& candidate, const double* plane, int stride) const
{
    PairCorners x;
    for (int i = 0; i < 4; ++i) {
        const int v = candidate.corner[i];
        x[i] = Vec3(plane[v], plane[stride + v], plane[2 * stride + v]);
    }
    return x;
}

// How far each particle has gone since the last look and is to go now, but for what all have in common.
void ClothContact::measure_ways(const State& state, const std::vector<real>* move)
{
    const int n = state.size.vertex_count, vs = state.size.vertex_stride;
    const bool first = seen_.empty();
    seen_.resize(std::size_t(n));
    gone_.resize(std::size_t(n));
    way_.resize(std::size_t(n));
    const auto mean_of = [n](const auto& component) {
        Vec3 mean;
        for (int c = 0; c < 3; ++c) mean[c] = sum_items(n, [&](int v) { return component(v, c); }) / n;
        return mean;
    };
    const Vec3 gone = first ? Vec3::Zero() : mean_of([&](int v, int c) { return state.pos[c * vs + v] - seen_[v][c]; });
    const Vec3 ahead = move ? mean_of([&](int v, int c) { return (*move)[c * vs + v]; }) : Vec3::Zero();
    for_each_item(n, [&, this](int v) {
        const Vec3 x(state.pos[v], state.pos[vs + v], state.pos[2 * vs + v]);
        gone_[v] = first ? 0 : rounded_up((x - seen_[v] - gone).norm());
        way_[v] = move ? rounded_up((Vec3((*move)[v], (*move)[vs + v], (*move)[2 * vs + v]) - ahead).norm()) : 0;
        seen_[v] = x;
    });
}

// Measures those candidates that may be in contact on the way; of the others a bound is enough to know that they are not.
void ClothContact::look_at_all(const State& state, const std::vector<real>* move, bool afresh)
{
    const std::vector<PairCandidate>& candidates = tree_.candidates();
    looks_.resize(candidates.size());
    measure_ways(state, move);
    const int vs = state.size.vertex_stride;
    for_each_item(int(candidates.size()), [&, this](int k) {
        const PairCandidate& candidate = candidates[k];
        const auto& c = candidate.corner;
        const auto both_sides = [&](const std::vector<float>& way) {
            return candidate.edges ? std::max(way[c[0]], way[c[1]]) + std::max(way[c[2]], way[c[3]])
                                   : way[c[0]] + std::max({way[c[1]], way[c[2]], way[c[3]]});
        };
        Look& look = looks_[k];
        look.approach = both_sides(way_);
        look.distance -= both_sides(gone_);
        look.near = afresh || look.distance - look.approach < gap_;
        if (!look.near) return;
        look.distance = rounded_down(pair_distance(corners_at(candidate, state.pos.data(), vs), candidate.edges));
        if (move) look.approach = rounded_up(pair_approach(corners_at(candidate, move->data(), vs), candidate.edges));
        look.near = look.distance - look.approach < gap_;
    });
    ++counts_.looks;
}

void ClothContact::update(State& state)
{
    const bool afresh = tree_.cover(state.pos.data(), nullptr, state.size.vertex_stride, {}, {}, gap_);
    look_at_all(state, nullptr, afresh);
    list_pairs(state);
}

void ClothContact::clear_way(State& state, std::vector<real>& move, bool uniform)
{
    const bool afresh = tree_.cover(state.pos.data(), move.data(), state.size.vertex_stride, {}, {}, gap_);
    look_at_all(state, &move, afresh);
    held_.assign(std::size_t(state.size.vertex_count), 0);
    int round = 0;
    while (hold_back(state, move, round, uniform || round >= rounds))
        if (uniform || round++ >= rounds) break;
    counts_.shortened += round > 0 || uniform;
    list_pairs(state);
}

// One round: cuts the moves of those who would hit something. Returns whether there were any.
bool ClothContact::hold_back(const State& state, std::vector<real>& move, int round, bool uniform)
{
    const std::vector<PairCandidate>& candidates = tree_.candidates();
    const int vs = state.size.vertex_stride;
    std::vector<float> fraction(candidates.size(), 1.0f);
    for_each_item(int(candidates.size()), [&, this](int k) {
        const PairCandidate& candidate = candidates[k];
        Look& look = looks_[k];
        if (!look.near && round == 0) return;
        // What moved along with a vertex that is held back now comes nearer to it.
        const bool changed = round > 0 && std::any_of(candidate.corner.begin(), candidate.corner.end(),
                                                      [this](int v) { return held_[v] != 0; });
        if (!changed && (round > 0 || look.approach < (1 - keep) * look.distance)) return;
        const PairCorners way = corners_at(candidate, move.data(), vs);
        const double approach = pair_approach(way, candidate.edges);
        if (!look.near) look.distance = rounded_down(pair_distance(corners_at(candidate, state.pos.data(), vs), candidate.edges));
        look.approach = std::max(look.approach, rounded_up(approach));
        look.near = look.distance - look.approach < gap_;
        if (approach < (1 - keep) * look.distance) return;
        const double free = free_fraction(corners_at(candidate, state.pos.data(), vs), way, candidate.edges,
                                          look.distance, approach, keep);
        if (free < 1) fraction[k] = std::nextafter(float(free), 0.0f);
    });
    const float least = fraction.empty() ? 1.0f : *std::min_element(fraction.begin(), fraction.end());
    if (least == 1.0f) return false;
    if (uniform) {
        for_each_item(int(move.size()), [&move, least](int i) { move[i] *= least; });
        return true;
    }
    std::vector<float> part(std::size_t(state.size.vertex_count), 1.0f);
    for (std::size_t k = 0; k < candidates.size(); ++k)
        if (fraction[k] < 1)
            for (int v : candidates[k].corner) part[v] = std::min(part[v], fraction[k]);
    for_each_item(state.size.vertex_count, [&](int v) {
        if (part[v] == 1.0f) return;
        held_[v] = 1;
        for (int c = 0; c < 3; ++c) move[c * vs + v] *= part[v];
    });
    return true;
}

double ClothContact::area_of(const State& state, const PairCandidate& candidate) const
{
    const auto area = [&](int i) { return area_[candidate.corner[i]]; };
    if (!candidate.edges) return 0.5 * area(0);
    // The closest points of edges jump where these are parallel: there the pairs of vertices and faces serve.
    const PairCorners x = corners_at(candidate, state.pos.data(), state.size.vertex_stride);
    const Vec3 a = x[1] - x[0], b = x[3] - x[2];
    const double s = a.cross(b).squaredNorm() / (a.squaredNorm() * b.squaredNorm() * parallel_sine * parallel_sine);
    return (area(0) + area(1) + area(2) + area(3)) / 24 * (s < 1 ? s * (2 - s) : 1);
}

// Writes those candidates that are in contact, or may come to be on the way, to the state; in an order that depends on
// nothing but themselves.
void ClothContact::list_pairs(State& state)
{
    const std::vector<PairCandidate>& candidates = tree_.candidates();
    listed_.clear();
    for (int k = 0; k < int(candidates.size()); ++k)
        if (looks_[k].near) listed_.push_back(k);
    tbb::parallel_sort(listed_.begin(), listed_.end(), [&](int a, int b) {
        const PairCandidate &p = candidates[a], &q = candidates[b];
        return p.edges != q.edges ? p.edges < q.edges : p.corner < q.corner;
    });
    const int count = int(listed_.size()), n = state.size.vertex_count, vs = state.size.vertex_stride;
    state.set_pairs(count);
    const int ps = state.size.pair_stride;
    for_each_item(count, [&, this](int p) {
        const PairCandidate& candidate = candidates[listed_[p]];
        for (int i = 0; i < 4; ++i) state.pair_vertex[i * ps + p] = candidate.corner[i];
        state.pair_edges[p] = candidate.edges;
        state.pair_area[p] = area_of(state, candidate);
    });
    std::vector<int> begin(std::size_t(n) + 1);
    for (int p = 0; p < count; ++p)
        for (int v : candidates[listed_[p]].corner) ++begin[v + 1];
    std::partial_sum(begin.begin(), begin.end(), begin.begin());
    for_each_item(n, [&](int v) {
        state.pair_slots[v] = begin[v];
        state.pair_slots[vs + v] = begin[v + 1];
    });
    for (int p = 0; p < count; ++p)
        for (int i = 0; i < 4; ++i) state.pair_slot[begin[candidates[listed_[p]].corner[i]]++] = 4 * p + i;
    recall(state);
}

void ClothContact::recall(State& state)
{
    if (state.pair_limit.empty()) return;
    std::fill(state.pair_limit.begin(), state.pair_limit.end(), 0);
}

void ClothContact::settle(State&, const Params&) {}

std::size_t ClothContact::bytes() const
{
    return tree_.bytes() + looks_.capacity() * sizeof(Look) + listed_.capacity() * sizeof(int) + area_.size() * 8 +
           memory_.capacity() * sizeof(real);
}

}  // namespace selvage
