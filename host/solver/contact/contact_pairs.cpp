#include "host/solver/contact/contact_pairs.hpp"

#include <algorithm>
#include <iterator>
#include <numeric>
#include <stdexcept>

#include <tbb/parallel_sort.h>

#include "host/parallel/launch.hpp"
#include "host/solver/contact/contact_tuning.hpp"
#include "host/solver/terms/bound_args.hpp"
#include "kernels/stages/settle_pairs.h"

namespace selvage {
namespace {

PairKey key_of(const State& state, int pair)
{
    PairKey key{state.pair_edges[pair] == 1, {}};
    for (int i = 0; i < 4; ++i) key.corner[i] = state.pair_vertex[i * state.size.pair_stride + pair];
    return key;
}

bool by_key(const PairCandidate& a, const PairCandidate& b) { return key_of(a) < key_of(b); }

PairFriction friction_in(const State& state, int pair)
{
    const int ps = state.size.pair_stride;
    PairFriction friction{key_of(state, pair), {}, {}, {}, state.pair_limit[pair]};
    for (int i = 0; i < 4; ++i) friction.weight[i] = state.pair_held_weight[i * ps + pair];
    for (int c = 0; c < 3; ++c) {
        friction.normal[c] = state.pair_held_normal[c * ps + pair];
        friction.bristle[c] = state.pair_bristle[c * ps + pair];
    }
    return friction;
}

void write_friction(State& state, int pair, const PairFriction& friction)
{
    const int ps = state.size.pair_stride;
    for (int i = 0; i < 4; ++i) state.pair_held_weight[i * ps + pair] = friction.weight[i];
    for (int c = 0; c < 3; ++c) {
        state.pair_held_normal[c * ps + pair] = friction.normal[c];
        state.pair_bristle[c * ps + pair] = friction.bristle[c];
    }
    state.pair_limit[pair] = friction.limit;
}

settle_pairs_args settle_args(State& state, const Params& params)
{
    settle_pairs_args a;
    a.contact = bound<cloth_contact_args>(state, params);
    a.repulsion = bound<cloth_repulsion_args>(state, params);
    a.friction = bound<cloth_friction_args>(state, params);
    settle_pairs_FIELDS(BIND_FIELD, BIND_FIELD);
    return a;
}

}  // namespace

void list_pair_slots(State& state)
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

ContactPairs::ContactPairs(const ContactGaps& gaps, ContactShares shares, std::vector<double> area,
                           std::vector<double> friction, std::vector<double> hardness)
    : gaps_(gaps), shares_(std::move(shares)), area_(std::move(area)), friction_(std::move(friction)),
      hardness_(std::move(hardness))
{
}

// A vertex stands for its area, an edge for a third of that of a vertex; each side of a contact has half.
double ContactPairs::area_of(const PairCandidate& candidate, const StraightStep& at) const
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
    const PairCorners x = at.start_of(candidate);
    const Vec3 a = x[1] - x[0], b = x[3] - x[2];
    constexpr double parallel_sine = ContactTuning::parallel_sine;
    const double s = a.cross(b).squaredNorm() / (a.squaredNorm() * b.squaredNorm() * parallel_sine * parallel_sine);
    return area / 3 * (s < 1 ? s * (2 - s) : 1);
}

// What the side asks that asks more.
double ContactPairs::hardness_of(const PairCandidate& candidate) const
{
    if (hardness_.empty()) return 1;
    double most = 0;
    for (int v : candidate.corner)
        if (v >= 0) most = std::max(most, hardness_[v]);
    return most;
}

// The mean of the particles'.
double ContactPairs::friction_of(const PairKey& pair) const
{
    double sum = 0;
    int of_cloth = 0;
    for (int v : pair.corner)
        if (v >= 0) {
            sum += friction_[v];
            ++of_cloth;
        }
    return sum / std::max(of_cloth, 1);
}

// @param near  in ascending order of their keys
std::vector<PairCandidate> ContactPairs::with_friction(const std::vector<PairCandidate>& near,
                                                       const CrossingFlags& crossings) const
{
    std::vector<PairCandidate> held, all;
    for (const PairFriction& friction : memory_) {
        const PairCandidate pair{friction.pair.corner, friction.pair.edges};
        if (!crossings.may_cross(pair)) held.push_back(pair);
    }
    std::set_union(near.begin(), near.end(), held.begin(), held.end(), std::back_inserter(all), by_key);
    return all;
}

void ContactPairs::list(State& state, const TreeBodies& bodies, std::vector<PairCandidate> near,
                        const CrossingFlags& crossings) const
{
    tbb::parallel_sort(near.begin(), near.end(), by_key);
    const std::vector<PairCandidate> pairs = with_friction(near, crossings);
    const int count = int(pairs.size());
    state.set_pairs(count);
    const int ps = state.size.pair_stride;
    const StraightStep at{state.pos, nullptr, state.size.vertex_stride, bodies};
    const std::vector<ContactShares::Share> shares = shares_.of(pairs, at);
    for_each_item(count, [&, this](int p) {
        const PairCandidate& candidate = pairs[p];
        for (int i = 0; i < 4; ++i) state.pair_vertex[i * ps + p] = candidate.corner[i];
        state.pair_edges[p] = candidate.edges ? 1 : shares[p].plane ? 2 : 0;
        state.pair_area[p] = shares[p].part * area_of(candidate, at) * hardness_of(candidate);
        state.pair_gap[p] = gaps_.of(candidate);
    });
    list_pair_slots(state);
    recall(state);
}

void ContactPairs::recall(State& state) const
{
    if (state.pair_limit.empty()) return;
    const PairFriction nothing;
    auto known = memory_.begin();
    for (int p = 0; p < state.size.pair_count; ++p) {
        const PairKey pair = key_of(state, p);
        while (known != memory_.end() && known->pair < pair) ++known;
        write_friction(state, p, known != memory_.end() && known->pair == pair ? *known : nothing);
        state.pair_friction[p] = friction_of(pair);
    }
}

// A vertex that has come from one face of a layer to another takes along how far friction had bent its bristle.
void ContactPairs::pass_on(State& state, int pair) const
{
    const int ps = state.size.pair_stride;
    const PairKey key = key_of(state, pair);
    if (key.edges || std::min(key.corner[0], key.corner[3]) < 0) return;
    const auto before = [](const PairFriction& of, const PairKey& at) { return of.pair < at; };
    auto known = std::lower_bound(memory_.begin(), memory_.end(), PairKey{false, {key.corner[0], -1, -1, -1}}, before);
    const auto first = key.corner.begin() + 1;
    const PairFriction* from = nullptr;
    for (; known != memory_.end() && !known->pair.edges && known->pair.corner[0] == key.corner[0]; ++known) {
        if (known->pair == key) return;
        const auto& of = known->pair.corner;
        const bool beside = std::find_first_of(of.begin() + 1, of.end(), first, key.corner.end()) != of.end();
        if (beside && (!from || known->limit > from->limit)) from = &*known;
    }
    if (!from) return;
    double along = 0;
    for (int c = 0; c < 3; ++c) along += state.pair_held_normal[c * ps + pair] * from->bristle[c];
    for (int c = 0; c < 3; ++c)
        state.pair_bristle[c * ps + pair] = from->bristle[c] - along * state.pair_held_normal[c * ps + pair];
}

void ContactPairs::remember(State& state)
{
    for (int p = 0; p < state.size.pair_count; ++p)
        if (state.pair_limit[p] > 0) pass_on(state, p);
    memory_.clear();
    for (int p = 0; p < state.size.pair_count; ++p)
        if (state.pair_limit[p] > 0) memory_.push_back(friction_in(state, p));
}

void ContactPairs::settle(State& state, const Params& params)
{
    if (state.pair_limit.empty()) return;
    const settle_pairs_args args = settle_args(state, params);
    launch<pair_frame>(state.size.pair_count, args.contact);
    launch<settle_pair>(state.size.pair_count, args);
    remember(state);
}

void ContactPairs::set_memory(FrictionMemory memory)
{
    if (!is_ordered(memory)) throw std::invalid_argument("the memory of friction is not in the order of its pairs");
    memory_ = std::move(memory);
}

}  // namespace selvage
