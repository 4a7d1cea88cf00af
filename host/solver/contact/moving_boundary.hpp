#pragma once
#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "host/model/body.hpp"
#include "host/solver/contact/ccd_filter.hpp"
#include "host/solver/state/state.hpp"

namespace selvage {

/// Bodies and held particles (pins) within a step of the solver: where they are, where they are to be at its end, how
/// far the cloth lets them go, and what of the cloth they carry along. PinPaths and BodyMotion say where they are to
/// be; this class gets them there without passing through the cloth.
class MovingBoundary {
public:
    /// A held particle and its place [m].
    using PinTarget = std::pair<int, Vec3>;
    /// Given the displacements of held particles, sets those of the others (planes like State::pos) [m].
    using Follow = std::function<void(std::vector<real>&)>;
    /// Called whenever bodies move on, with the part of the way to their targets that they go [1].
    using Carry = std::function<void(State&, double)>;

    /// @param bodies  those that the cloth may touch
    explicit MovingBoundary(std::vector<Body> bodies);

    const std::vector<Body>& bodies() const { return bodies_; }
    /// Where the bodies' corners are, in the order of the bodies.
    TreeBodies corners() const { return {corners_, nullptr, version_}; }
    bool moves() const { return any_moves(bodies_); }  ///< Whether any body moves in the scene.

    void set_carry(Carry carry) { carry_ = std::move(carry); }

    /// Sets where bodies and pins are to be at the end of a step. @param time  of the step's end [s]
    void set_targets(std::vector<PinTarget> pins, double time);
    /// Puts bodies where they are at a time, at the start or when a step is given up.
    void place_bodies(State& state, double time);
    /// Writes the bodies' corners to the state's field.
    void write_corners(State& state) const;

    /// Moves bodies and pins on as far as the cloth makes way. What bodies push or hold by friction goes along with
    /// their surface. The candidates of `filter` are not those of the new place.
    /// @param follow  how the cloth would follow pins
    void advance(State& state, CcdFilter& filter, const Follow& follow);
    /// Finds the pair that bodies and pins would pass through first on the rest of their way, to tell what is in it.
    /// As after advance, the candidates of `filter` are those of another place.
    std::optional<PairCandidate> obstacle(const State& state, CcdFilter& filter) const;
    /// The body that a corner below zero belongs to.
    const Body& body_of_corner(int corner) const;
    /// True while bodies or pins are not yet at their targets.
    bool is_pending() const { return pending_; }

    std::size_t bytes() const { return (corners_.capacity() + target_corners_.capacity()) * sizeof(Vec3); }

private:
    std::vector<Vec3> body_displacements() const;
    bool displace_pins(const State& state, std::vector<real>& displacement) const;
    void carry_along(const State& state, const CcdFilter& filter, const StraightStep& step,
                     std::vector<real>& displacement) const;
    void limit_followers(const State& state, CcdFilter& filter, const StraightStep& step,
                         std::vector<real>& displacement) const;
    float filter_advance(const State& state, CcdFilter& filter, const StraightStep& step,
                         std::vector<real>& displacement) const;
    void take(State& state, float fraction, const std::vector<real>& displacement,
              const std::vector<Vec3>& body_displacement);

    std::vector<Body> bodies_;
    std::vector<Vec3> corners_, target_corners_;  // of all bodies, now and at the end of the step [m]
    int version_ = 0;                             // changes with corners_
    std::vector<PinTarget> pins_;
    bool pending_ = false;
    Carry carry_;
};

}  // namespace selvage
