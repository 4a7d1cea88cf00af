#pragma once
#include <vector>

#include "host/collision/ccd.hpp"
#include "host/collision/cloth_tree.hpp"
#include "host/solver/contact/contact_gaps.hpp"
#include "host/solver/contact/crossing_flags.hpp"
#include "kernels/portable.h"

namespace selvage {

/// A straight step of all corners: particles (index v >= 0) and corners of bodies (index -1 - k).
struct StraightStep {
    const std::vector<real>& start;                   ///< Of particles, planes like State::pos [m].
    const std::vector<real>* displacement = nullptr;  ///< Likewise [m]; null: no particle moves.
    int stride = 0;                                   ///< Of the planes.
    TreeBodies bodies;                                ///< Where the bodies start, and their displacements.

    Vec3 start_of(int corner) const
    {
        if (corner < 0) return bodies.corners[-1 - corner];
        return {start[corner], start[stride + corner], start[2 * stride + corner]};
    }
    Vec3 displacement_of(int corner) const
    {
        if (corner < 0) return bodies.moves ? (*bodies.moves)[-1 - corner] : Vec3(Vec3::Zero());
        const std::vector<real>& u = *displacement;
        return {u[corner], u[stride + corner], u[2 * stride + corner]};
    }
    PairCorners start_of(const PairCandidate& candidate) const;
    PairCorners displacement_of(const PairCandidate& candidate) const;
};

/// What is known of a candidate's distance on the last step that candidates were refreshed for.
struct PairDistance {
    float distance = 0;     ///< At the start, a lower bound; exact where `relevant` [m].
    float approach = 0;     ///< How far the two sides may come nearer, an upper bound [m].
    float apart = 0;        ///< How far apart they stay during the step, a lower bound [m].
    bool relevant = false;  ///< The pair may come as near as it is looked for. Depends on nothing but place and step.
};

/// How much of their distance the pairs keep in a step; see ContactTuning.
struct StepMargins {
    double kept = 0;    ///< Share of a pair's room above the floor [1].
    double scarce = 0;  ///< Least room that is left, of the gap at which the pair's contact sets in [1].
};

/// What a filter takes from one refresh to the next.
struct CcdMemory {
    TreeMemory tree;
    std::vector<PairDistance> distances;  ///< Per candidate.
    std::vector<Vec3> position;           ///< Of each corner at the last refresh, particles first [m].
};

struct CcdCounts {
    long long refreshes = 0;  ///< Times that candidates were looked for or proved to be complete.
    long long shortened = 0;  ///< Steps that filter_step cut.
};

/// Continuous collision detection of the cloth with itself and with bodies: owns the tree and its candidates, tells
/// which fraction of a straight step no pair passes through another in, and shortens steps to it. Knows neither forces
/// nor the solver.
class CcdFilter {
public:
    /// @param surface    of the cloth and the bodies   @param slack  of the tree's boxes [m]
    /// @param gaps       must outlive this object, as must crossings
    /// @param body_reach distance up to which cloth is compared with bodies, at most gaps.largest() [m]
    /// @param crossings  which pairs may cross
    CcdFilter(TreeSurface surface, double slack, const ContactGaps& gaps, double body_reach,
              const CrossingFlags& crossings);

    /// The margins of steps of the cloth itself.
    StepMargins margins() const;
    /// The margins of steps of bodies and pins, between which the cloth makes way.
    StepMargins held_margins() const;

    /// Makes candidates and distances complete for a step: all queries below are about the step last given here.
    void refresh(const StraightStep& step);

    /// Returns the fraction of the whole step that is free; at most 1.
    float free_fraction(const StraightStep& step, const StepMargins& margins) const;
    /// Returns the free fraction of every candidate; 1 where nothing is in the way.
    std::vector<float> free_fractions(const StraightStep& step, const StepMargins& margins) const;
    /// Scales the displacements of those particles whose pairs are not free for all of it.
    /// @param fractions  per candidate @returns true if any is below 1
    bool limit_vertices(std::vector<real>& displacement, int stride, const std::vector<float>& fractions) const;

    /// Shortens a displacement until the straight step is free. The step starts at `start`; bodies stand still.
    /// Candidates and distances are complete for the shortened step afterwards.
    /// @param displacement  planes like start [m]
    /// @param uniform  true: the whole displacement is scaled; false: at first only around what would be hit
    void filter_step(const std::vector<real>& start, std::vector<real>& displacement, int stride,
                     const TreeBodies& bodies, bool uniform);

    /// Refreshes for a step that has been taken already; returns true if nothing is passed through on it.
    bool is_free(const StraightStep& step);

    /// Returns those candidates that are within their gap, or may come to be on the step.
    std::vector<PairCandidate> within_gap() const;

    const std::vector<PairCandidate>& candidates() const { return tree_.candidates(); }
    const std::vector<PairDistance>& distances() const { return distances_; }  ///< Per candidate.
    const ContactGaps& gaps() const { return gaps_; }

    /// Treats particles as at rest. @param is_awake  per particle; null: all move
    void let_sleep(const std::vector<char>* is_awake) { tree_.let_sleep(is_awake); }
    /// The next refresh searches: what it finds then depends on nothing that went before.
    void forget() { tree_.forget(); }
    /// For checkpoints; see ClothTree::memory.
    CcdMemory memory(const TreeBodies& bodies) const;
    /// Takes over a memory. The last refresh must have been for the present place, with these bodies.
    /// @throws std::invalid_argument if it is of another surface
    void set_memory(CcdMemory memory);

    const CcdCounts& counts() const { return counts_; }
    const TreeCounts& searches() const { return tree_.counts(); }
    std::size_t bytes() const;

private:
    int slot(int corner) const { return corner >= 0 ? corner : particles_ - 1 - corner; }
    double least_distance(const PairCandidate& candidate, const PairDistance& at, const StepMargins& margins) const;
    void measure_displacements(const StraightStep& step);
    void measure_distances(const StraightStep& step, bool changed);
    double reach_of(const PairCandidate& candidate) const
    {
        return has_body(candidate) ? body_reach_ : gaps_.largest();
    }
    float free_fraction_of(int candidate, const StraightStep& step, const StepMargins& margins, float enough) const;

    const ContactGaps& gaps_;
    double body_reach_;
    int particles_;
    const CrossingFlags& crossings_;
    ClothTree tree_;
    std::vector<PairDistance> distances_;          // per candidate
    std::vector<Vec3> last_position_;              // per corner, at the last refresh [m]
    std::vector<float> travelled_, displacement_;  // per corner: since the last refresh and in this step [m]
    CcdCounts counts_;
};

}  // namespace selvage
