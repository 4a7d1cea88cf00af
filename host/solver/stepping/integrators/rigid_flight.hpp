#pragma once
#include <vector>

#include "host/solver/state/state.hpp"
#include "host/solver/terms/params.hpp"

namespace selvage {

/// Where cloth may be after a step: every connected piece of it flies and turns on as a rigid body, and its vertices
/// keep their velocities within the turning frame. Free flight of a rigid piece is then exact, and what is stiff is not
/// stretched by its own guess. A piece that is held turns about what holds it.
class RigidFlight {
public:
    /// @param state  whose elements tell which vertices are connected
    explicit RigidFlight(const State& state);

    /// Writes where the vertices may be: pos + ahead * vel + half * acceleration of each piece's rigid motion, its turn
    /// being a rotation. Pinned vertices stay.
    /// @param ahead         [s]   @param half  [s^2]
    /// @param acceleration  planes like pos [m/s^2]   @param place  receives positions, planes like pos [m]
    void predict(const State& state, double ahead, double half, const std::vector<real>& acceleration,
                 std::vector<real>& place) const;
    /// The same at constant acceleration, with the velocities then. @param ahead  [s]; below 0: where it came from
    void fly(const State& state, double ahead, const std::vector<real>& acceleration, std::vector<real>& place,
             std::vector<real>& velocity) const;

private:
    struct Motion;
    Motion motion_of(const State& state, int piece, const std::vector<real>& acceleration) const;

    std::vector<int> first_, vertices_;  ///< The vertices of each piece, from first_[p] to first_[p + 1].
};

/// Fills a field, planes like pos, with the acceleration of gravity at free vertices and 0 at pinned ones [m/s^2].
void fill_gravity(const State& state, const Params& params, std::vector<real>& acceleration);

/// Fills a field with the mean acceleration of the step before, or with that of gravity where there was none [m/s^2].
/// @param gain  of the velocities in that step, planes like pos [m/s]   @param dt  its length [s]; 0 or less: none
void fill_acceleration(const State& state, const Params& params, const std::vector<real>& gain, double dt,
                       std::vector<real>& acceleration);

}  // namespace selvage
