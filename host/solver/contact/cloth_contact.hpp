#pragma once
#include <vector>

#include "host/model/body.hpp"
#include "host/model/cloth.hpp"
#include "host/solver/contact/ccd_filter.hpp"
#include "host/solver/contact/contact_gaps.hpp"
#include "host/solver/contact/contact_pairs.hpp"
#include "host/solver/contact/moving_boundary.hpp"
#include "host/solver/contact/tangles.hpp"
#include "host/solver/state/state.hpp"
#include "host/solver/state/topology.hpp"
#include "host/solver/terms/params.hpp"

namespace selvage {

/// What a run reports of contact between cloth and cloth.
struct ClothContactCounts {
    long long refreshes = 0;  ///< Times that candidates were looked for or proved to be complete.
    long long shortened = 0;  ///< Steps that were cut since something would have been passed through.
    int inside = 0;           ///< Vertices that started inside a body and are still there.
    int tangles = 0;          ///< Pairs of triangles that intersect and may pass through each other.
};

/// Contact of the cloth with itself, and of its faces and edges with bodies: keeps the pairs in the state's fields up
/// to date and every step free of crossings. Cloth that starts free of intersections stays so, since whatever moves the
/// cloth, the bodies or held vertices asks here first. Contact of vertices with bodies is ClothBodyContact's; here
/// their steps are filtered as well.
///
/// What a solver holds and calls; the work is done by four classes that know nothing of each other's state: CcdFilter,
/// ContactPairs, MovingBoundary and Tangles.
class ClothContact {
public:
    /// @param bodies    those that can be touched; left out are those that cloth is clear of whose vertices are
    /// @param gaps      distances at which contact sets in
    /// @param friction  per particle [1]
    /// @param hardness  ContactHardness::of_pairs; empty: 1
    ClothContact(const Topology& topology, const Cloth& cloth, const std::vector<Body>& bodies, ContactGaps gaps,
                 std::vector<double> friction, std::vector<double> hardness = {});
    ClothContact(const ClothContact&) = delete;  // its parts refer to each other

    /// Looks for intersections that are there at the start.
    void begin(State& state);

    /// Treats particles as at rest. @param is_awake  per particle; null: all move
    void let_sleep(const std::vector<char>* is_awake) { filter_.let_sleep(is_awake); }

    /// Forgets what has been found, where the cloth starts elsewhere.
    void forget_searches() { filter_.forget(); }

    /// Lists the pairs that are in contact at state.pos.
    void update(State& state);

    /// Shortens a displacement until the straight step from state.pos is free: each pair keeps a part of its distance.
    /// Lists all pairs that are in contact somewhere on the step.
    /// @param displacement  planes like pos [m]
    /// @param uniform  true: all of it is scaled; false: at first only around what would be hit
    void filter_step(State& state, std::vector<real>& displacement, bool uniform);

    /// Returns true if nothing is passed through on the straight step from `from` (planes like pos) to state.pos.
    bool is_clear_from(State& state, const std::vector<real>& from);

    /// See MovingBoundary.
    void set_carry(MovingBoundary::Carry carry) { boundary_.set_carry(std::move(carry)); }
    /// Sets where bodies and held particles are to be at the end of a step [m, s].
    void set_boundary_targets(std::vector<MovingBoundary::PinTarget> pins, double time)
    {
        boundary_.set_targets(std::move(pins), time);
    }
    /// Moves them on as far as the cloth makes way, and lists the pairs there. @returns boundary_is_pending()
    bool advance_boundary(State& state, const MovingBoundary::Follow& follow);
    /// True while they are not yet where they are to be.
    bool boundary_is_pending() const { return boundary_.is_pending(); }
    /// See MovingBoundary.
    std::optional<PairCandidate> obstacle(const State& state) { return boundary_.obstacle(state, filter_); }
    /// Where the first side of a pair is nearest to the second [m].
    Vec3 nearest_point(const State& state, const PairCandidate& pair) const;
    const Body& body_of_corner(int corner) const { return boundary_.body_of_corner(corner); }
    /// Puts bodies where they are at a time, at the start or when a step is given up.
    void place_bodies(State& state, double time) { boundary_.place_bodies(state, time); }

    /// Ends a step: friction slips and is remembered, and what has come apart is no longer tangled.
    void settle(State& state, const Params& params);

    /// What friction remembers, for retries and checkpoints.
    const FrictionMemory& memory() const { return pairs_.memory(); }
    void set_memory(FrictionMemory memory) { pairs_.set_memory(std::move(memory)); }

    /// What searches for pairs have found, for checkpoints: later searches may begin with it.
    CcdMemory searches() const { return filter_.memory(boundary_.corners()); }
    /// Takes them over. @param state  at its present place, with its pairs listed there
    /// @throws std::invalid_argument if they are of another cloth or other bodies
    void set_searches(CcdMemory memory) { filter_.set_memory(std::move(memory)); }

    /// What crosses, per particle.
    const CrossingFlags& crossings() const { return tangles_.flags(); }
    void set_crossings(CrossingFlags flags) { tangles_.set_flags(std::move(flags)); }

    /// True if anything may have come near the cloth on the last step that was filtered.
    bool has_candidates() const { return !filter_.candidates().empty(); }
    ClothContactCounts counts() const;
    const TreeCounts& search_counts() const { return filter_.searches(); }
    std::size_t bytes() const { return gaps_.bytes() + filter_.bytes() + pairs_.bytes() + boundary_.bytes(); }

private:
    void list_pairs(State& state) { pairs_.list(state, boundary_.corners(), filter_.within_gap(), tangles_.flags()); }

    ContactGaps gaps_;
    MovingBoundary boundary_;
    Tangles tangles_;
    CcdFilter filter_;
    ContactPairs pairs_;
};

}  // namespace selvage
