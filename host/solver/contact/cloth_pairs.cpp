// The pairs of a ClothContact in the state's fields, and what friction remembers of them.
#include <algorithm>
#include <numeric>

#include <tbb/parallel_sort.h>

#include "host/parallel/launch.hpp"
#include "host/solver/contact/cloth_contact.hpp"
#include "kernels/stages/settle_pairs.h"

namespace selvage {
namespace {

constexpr double parallel_sine = 0.1;  // edges that cross at a smaller sine count less

bool before(const PairCandidate& p, const PairCandidate& q)
{
    return p.edges != q.edges ? p.edges < q.edges : p.corner < q.corner;
}

PairCandidate recorded(const real* record)
{
    return {{int(record[0]), int(record[1]), int(record[2]), int(record[3])}, record[4] != 0};
}

settle_pairs_args settling(State& s, const Params& params)
{
    settle_pairs_args a{};
    a.contact.size = a.friction.size = s.size;
    a.contact.pos = a.friction.pos = s.pos.data();
    a.contact.body_point = a.friction.body_point = s.body_point.data();
    a.contact.pair_vertex = a.friction.pair_vertex = s.pair_vertex.data();
    a.contact.pair_edges = s.pair_edges.data();
    a.contact.pair_area = s.pair_area.data();
    a.contact.pair_gap = s.pair_gap.data();
    a.contact.pair_weight = s.pair_weight.data();
    a.contact.pair_normal = s.pair_normal.data();
    a.contact.pair_distance = s.pair_distance.data();
    a.contact.stiffness = params.cloth_contact.stiffness;
    a.repulsion.pair_area = s.pair_area.data();
    a.repulsion.pair_gap = s.pair_gap.data();
    a.repulsion.pair_distance = s.pair_distance.data();
    a.repulsion.stiffness = params.cloth_repulsion.stiffness;
    a.friction.pair_held_weight = a.held_weight = s.pair_held_weight.data();
    a.friction.pair_held_normal = a.held_normal = s.pair_held_normal.data();
    a.friction.pair_bristle = a.bristle = s.pair_bristle.data();
    a.friction.pair_friction = s.pair_friction.data();
    a.friction.pair_limit = a.limit = s.pair_limit.data();
    a.friction.stick_distance = params.cloth_friction.stick_distance;
    return a;
}

}  // namespace

// A vertex stands for its area, an edge for a third of that of a vertex; each side of a contact has half.
double ClothContact::area_of(const PairCandidate& candidate, const Way& way) const
{
    double sum = 0;
    int count = 0;
    for (int i = candidate.edges ? 0 : candidate.corner[0] < 0;
         i < (candidate.edges || candidate.corner[0] < 0 ? 4 : 1); ++i)
        if (candidate.corner[i] >= 0) {
            sum += area_[candidate.corner[i]];
            ++count;
        }
    const double area = 0.5 * sum / std::max(count, 1);
    if (!candidate.edges) return area;
    // The closest points of edges jump where these are parallel: there the pairs of vertices and faces serve.
    const PairCorners x = places(candidate, way);
    const Vec3 a = x[1] - x[0], b = x[3] - x[2];
    const double s = a.cross(b).squaredNorm() / (a.squaredNorm() * b.squaredNorm() * parallel_sine * parallel_sine);
    return area / 3 * (s < 1 ? s * (2 - s) : 1);
}

// Writes those candidates that are in contact, or may come to be on the way, to the state; in an order that depends on
// nothing but themselves.
void ClothContact::list_pairs(State& state)
{
    const std::vector<PairCandidate>& candidates = tree_.candidates();
    listed_.clear();
    for (int k = 0; k < int(candidates.size()); ++k) {
        if (!looks_[k].near) continue;
        const double gap = gap_of(candidates[k]);
        if (gap > 0 && looks_[k].distance - looks_[k].approach < gap && !may_pass(candidates[k])) listed_.push_back(k);
    }
    tbb::parallel_sort(listed_.begin(), listed_.end(),
                       [&](int a, int b) { return before(candidates[a], candidates[b]); });
    const int count = int(listed_.size());
    state.set_pairs(count);
    const int ps = state.size.pair_stride;
    const Way way{state.pos, nullptr, nullptr, state.size.vertex_stride};
    for_each_item(count, [&, this](int p) {
        const PairCandidate& candidate = candidates[listed_[p]];
        for (int i = 0; i < 4; ++i) state.pair_vertex[i * ps + p] = candidate.corner[i];
        state.pair_edges[p] = candidate.edges;
        state.pair_area[p] = area_of(candidate, way);
        state.pair_gap[p] = gap_of(candidate);
    });
    list_slots(state);
    recall(state);
}

void ClothContact::list_slots(State& state) const
{
    const int count = state.size.pair_count, ps = state.size.pair_stride, n = state.size.vertex_count;
    std::vector<int> begin(std::size_t(n) + 1);
    for (int p = 0; p < count; ++p)
        for (int i = 0; i < 4; ++i)
            if (const int v = state.pair_vertex[i * ps + p]; v >= 0) ++begin[v + 1];
    std::partial_sum(begin.begin(), begin.end(), begin.begin());
    for_each_item(n, [&, vs = state.size.vertex_stride](int v) {
        state.pair_slots[v] = begin[v];
        state.pair_slots[vs + v] = begin[v + 1];
    });
    for (int p = 0; p < count; ++p)
        for (int i = 0; i < 4; ++i)
            if (const int v = state.pair_vertex[i * ps + p]; v >= 0) state.pair_slot[begin[v]++] = 4 * p + i;
}

// Gives the listed pairs what friction remembers of them; both are in the same order.
void ClothContact::recall(State& state) const
{
    if (state.pair_limit.empty()) return;
    const std::vector<PairCandidate>& candidates = tree_.candidates();
    const int ps = state.size.pair_stride;
    const real *record = memory_.data(), *end = record + memory_.size();
    for (int p = 0; p < state.size.pair_count; ++p) {
        const PairCandidate& pair = candidates[listed_[p]];
        while (record != end && before(recorded(record), pair)) record += memory_size;
        const bool known = record != end && !before(pair, recorded(record));
        for (int i = 0; i < 4; ++i) state.pair_held_weight[i * ps + p] = known ? record[5 + i] : 0;
        for (int c = 0; c < 3; ++c) {
            state.pair_held_normal[c * ps + p] = known ? record[9 + c] : 0;
            state.pair_bristle[c * ps + p] = known ? record[12 + c] : 0;
        }
        state.pair_limit[p] = known ? record[15] : 0;
        double mean = 0;
        int of_cloth = 0;
        for (int v : pair.corner)
            if (v >= 0) {
                mean += friction_[v];
                ++of_cloth;
            }
        state.pair_friction[p] = mean / std::max(of_cloth, 1);
    }
}

void ClothContact::remember(const State& state)
{
    const int ps = state.size.pair_stride;
    memory_.clear();
    for (int p = 0; p < state.size.pair_count; ++p) {
        if (!(state.pair_limit[p] > 0)) continue;
        for (int i = 0; i < 4; ++i) memory_.push_back(state.pair_vertex[i * ps + p]);
        memory_.push_back(state.pair_edges[p]);
        for (int i = 0; i < 4; ++i) memory_.push_back(state.pair_held_weight[i * ps + p]);
        for (int c = 0; c < 3; ++c) memory_.push_back(state.pair_held_normal[c * ps + p]);
        for (int c = 0; c < 3; ++c) memory_.push_back(state.pair_bristle[c * ps + p]);
        memory_.push_back(state.pair_limit[p]);
    }
}

void ClothContact::settle(State& state, const Params& params)
{
    if (counts_.tangles > 0) find_tangles(state);
    if (counts_.inside > 0) find_inside(state);
    if (state.pair_limit.empty()) return;
    const settle_pairs_args args = settling(state, params);
    launch<pair_frame>(state.size.pair_count, args.contact);
    launch<settle_pair>(state.size.pair_count, args);
    remember(state);
}

}  // namespace selvage
