#include "host/solver/contact/ccd_filter.hpp"

#include <algorithm>
#include <atomic>
#include <stdexcept>

#include "host/parallel/launch.hpp"
#include "host/solver/contact/contact_tuning.hpp"

namespace selvage {

PairCorners StraightStep::start_of(const PairCandidate& candidate) const
{
    const auto& c = candidate.corner;
    return {start_of(c[0]), start_of(c[1]), start_of(c[2]), start_of(c[3])};
}

PairCorners StraightStep::displacement_of(const PairCandidate& candidate) const
{
    const auto& c = candidate.corner;
    return {displacement_of(c[0]), displacement_of(c[1]), displacement_of(c[2]), displacement_of(c[3])};
}

CcdFilter::CcdFilter(TreeSurface surface, double slack, const ContactGaps& gaps, double body_reach,
                     const CrossingFlags& crossings)
    : gaps_(gaps), body_reach_(body_reach), particles_(int(surface.group_of.size())), crossings_(crossings),
      tree_(std::move(surface), slack)
{
}

StepMargins CcdFilter::margins() const { return {ContactTuning::kept, ContactTuning::scarce}; }

StepMargins CcdFilter::held_margins() const { return {ContactTuning::held_kept, ContactTuning::held_scarce}; }

// How near a pair may come in one step. No barrier lets it come to its floor, and many steps one after the other must
// not lead to where rounding decides either.
double CcdFilter::least_distance(const PairCandidate& candidate, const PairDistance& at,
                                 const StepMargins& margins) const
{
    const double gap = gaps_.of_cloth(candidate);
    const double floor = ContactTuning::floor * (has_body(candidate) ? ContactTuning::body_gap * gap : gap);
    const double distance = std::min<double>(at.distance, gap), room = distance - floor;
    constexpr double nearly_all = ContactTuning::kept_of_scarce;
    if (room <= 0) return nearly_all * distance;
    const double scarce = margins.scarce * gap;
    return floor + (room > 2 * scarce ? std::max(margins.kept * room, scarce) : nearly_all * room);
}

void CcdFilter::refresh(const StraightStep& step)
{
    const bool changed = tree_.cover(step.start.data(), step.displacement ? step.displacement->data() : nullptr,
                                     step.stride, step.bodies, gaps_.largest(), body_reach_);
    measure_distances(step, changed);
}

// How far each corner has travelled since the last refresh and is to go now, but for what the whole cloth has in
// common.
void CcdFilter::measure_displacements(const StraightStep& step)
{
    const int n = particles_, m = int(step.bodies.corners.size());
    const bool first = last_position_.empty();
    for (std::vector<float>* lengths : {&travelled_, &displacement_}) lengths->resize(std::size_t(n + m));
    last_position_.resize(std::size_t(n + m));
    const auto mean_of = [n](const auto& component) {
        Vec3 mean;
        for (int c = 0; c < 3; ++c) mean[c] = sum_items(n, [&](int v) { return component(v, c); }) / n;
        return mean;
    };
    const Vec3 travelled =
        first ? Vec3(Vec3::Zero())
              : mean_of([&](int v, int c) { return step.start[c * step.stride + v] - last_position_[v][c]; });
    const Vec3 ahead = step.displacement
                           ? mean_of([&](int v, int c) { return (*step.displacement)[c * step.stride + v]; })
                           : Vec3(Vec3::Zero());
    for_each_item(n + m, [&, this](int k) {
        const int corner = k < n ? k : n - 1 - k;
        const Vec3 x = step.start_of(corner);
        travelled_[k] = first ? 0 : rounded_up((x - last_position_[k] - travelled).norm());
        displacement_[k] = step.displacement ? rounded_up((step.displacement_of(corner) - ahead).norm()) : 0;
        last_position_[k] = x;
    });
}

// Measures those candidates that may come within the gap on the step; of the others a bound is enough to know that
// they do not. What is measured, and what counts as relevant, does not depend on when a candidate was found.
void CcdFilter::measure_distances(const StraightStep& step, bool changed)
{
    const std::vector<PairCandidate>& candidates = tree_.candidates();
    const std::vector<int>& kept_from = tree_.kept_from();
    const std::size_t kept = changed ? kept_from.size() : candidates.size();
    if (changed)
        for (std::size_t k = 0; k < kept; ++k) distances_[k] = distances_[kept_from[k]];
    distances_.resize(candidates.size());
    ++counts_.refreshes;
    if (candidates.empty()) {
        last_position_.clear();  // where corners were means nothing to the next candidates, which are new
        return;
    }
    measure_displacements(step);
    for_each_item(int(candidates.size()), [&, this](int k) {
        const PairCandidate& candidate = candidates[k];
        std::array<int, 4> c;
        for (int i = 0; i < 4; ++i) c[i] = slot(candidate.corner[i]);
        const auto both_sides = [&](const std::vector<float>& of) {
            return candidate.edges ? std::max(of[c[0]], of[c[1]]) + std::max(of[c[2]], of[c[3]])
                                   : of[c[0]] + std::max({of[c[1]], of[c[2]], of[c[3]]});
        };
        PairDistance& at = distances_[k];
        const float displaced = both_sides(displacement_);
        const double reach = reach_of(candidate);
        at.approach = displaced;
        at.distance =
            std::size_t(k) < kept ? rounded_down(double(at.distance) - both_sides(travelled_)) : candidate.distance;
        at.apart = rounded_down(double(at.distance) - displaced);
        at.relevant = at.apart < reach;
        if (!at.relevant) return;
        const PairCorners x = step.start_of(candidate);
        const Vec3 difference = pair_difference(x, candidate.edges);
        at.distance = at.apart = rounded_down(difference.norm());
        if (step.displacement) {
            const PairCorners displacement = step.displacement_of(candidate);
            at.approach = rounded_up(pair_approach(displacement, candidate.edges));
            const double by_lengths = double(at.distance) - std::min(displaced, at.approach);
            at.apart = rounded_down(std::max(by_lengths, kept_apart(x, displacement, candidate.edges, difference)));
        }
        at.relevant = at.apart < reach;
    });
}

// @param enough  1 is returned where at least this much is free
float CcdFilter::free_fraction_of(int k, const StraightStep& step, const StepMargins& margins, float enough) const
{
    const PairDistance& at = distances_[k];
    if (!at.relevant) return 1;
    const PairCandidate& candidate = tree_.candidates()[k];
    const double least = least_distance(candidate, at, margins);
    if (at.apart > least || crossings_.may_cross(candidate)) return 1;
    const double fraction = selvage::free_fraction(step.start_of(candidate), step.displacement_of(candidate),
                                                   candidate.edges, at.distance, at.approach, least, enough);
    return fraction < 1 ? rounded_down(fraction) : 1;
}

std::vector<float> CcdFilter::free_fractions(const StraightStep& step, const StepMargins& margins) const
{
    std::vector<float> fractions(tree_.candidates().size(), 1.0f);
    for_each_item(int(fractions.size()), [&, this](int k) { fractions[k] = free_fraction_of(k, step, margins, 1); });
    return fractions;
}

// A candidate that is free for as much as others leave is not examined any further.
float CcdFilter::free_fraction(const StraightStep& step, const StepMargins& margins) const
{
    std::atomic<float> least = 1;
    for_each_item(int(tree_.candidates().size()), [&, this](int k) {
        float so_far = least.load(std::memory_order_relaxed);
        const float fraction = free_fraction_of(k, step, margins, so_far);
        while (fraction < so_far && !least.compare_exchange_weak(so_far, fraction)) {
        }
    });
    return least;
}

bool CcdFilter::limit_vertices(std::vector<real>& displacement, int stride, const std::vector<float>& fractions) const
{
    const std::vector<PairCandidate>& candidates = tree_.candidates();
    std::vector<float> of_vertex(std::size_t(particles_), 1.0f);
    bool any = false;
    for (std::size_t k = 0; k < candidates.size(); ++k) {
        if (fractions[k] == 1) continue;
        any = true;
        for (int v : candidates[k].corner)
            if (v >= 0) of_vertex[v] = std::min(of_vertex[v], fractions[k]);
    }
    for_each_item(particles_, [&](int v) {
        if (of_vertex[v] == 1) return;
        for (int c = 0; c < 3; ++c) displacement[c * stride + v] *= of_vertex[v];
    });
    return any;
}

void CcdFilter::filter_step(const std::vector<real>& start, std::vector<real>& displacement, int stride,
                            const TreeBodies& bodies, bool uniform)
{
    const StraightStep step{start, &displacement, stride, bodies};
    refresh(step);
    bool free = false, cut = false;
    for (int round = 0; round < ContactTuning::local_rounds && !uniform && !free; ++round) {
        free = !limit_vertices(displacement, stride, free_fractions(step, margins()));
        if (free) break;
        cut = true;
        refresh(step);  // what moved along with a vertex that now goes less far comes nearer to it
    }
    if (!free) {
        const float fraction = free_fraction(step, margins());
        if (fraction < 1)
            for_each_item(int(displacement.size()), [&displacement, fraction](int i) { displacement[i] *= fraction; });
        cut = cut || fraction < 1;
    }
    counts_.shortened += cut;
}

bool CcdFilter::is_free(const StraightStep& step)
{
    refresh(step);
    return free_fraction(step, margins()) == 1;
}

std::vector<PairCandidate> CcdFilter::within_gap() const
{
    const std::vector<PairCandidate>& candidates = tree_.candidates();
    std::vector<PairCandidate> result;
    for (int k = 0; k < int(candidates.size()); ++k) {
        const PairDistance& at = distances_[k];
        if (!at.relevant) continue;
        const double gap = gaps_.of(candidates[k]);
        if (gap > 0 && at.apart < gap && !crossings_.may_cross(candidates[k])) result.push_back(candidates[k]);
    }
    return result;
}

CcdMemory CcdFilter::memory(const TreeBodies& bodies) const
{
    CcdMemory memory{tree_.memory(bodies), {}, {}};
    if (!memory.tree.valid) return memory;
    memory.distances = distances_;
    memory.position = last_position_;
    return memory;
}

void CcdFilter::set_memory(CcdMemory memory)
{
    const std::size_t corners = std::size_t(slot(-1)) + tree_.body_corner_count();
    if (memory.distances.size() != memory.tree.candidates.size() ||
        !(memory.position.empty() || memory.position.size() == corners))
        throw std::invalid_argument("the memory of a filter for another surface");
    const bool valid = memory.tree.valid;
    tree_.set_memory(std::move(memory.tree));
    if (!valid) return;
    distances_ = std::move(memory.distances);
    last_position_ = std::move(memory.position);
}

std::size_t CcdFilter::bytes() const
{
    return tree_.bytes() + distances_.capacity() * sizeof(PairDistance) + last_position_.capacity() * sizeof(Vec3) +
           (travelled_.capacity() + displacement_.capacity()) * sizeof(float);
}

}  // namespace selvage
