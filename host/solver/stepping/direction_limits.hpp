#pragma once
#include <vector>

#include "host/solver/stepping/system.hpp"

namespace selvage {

/// The largest displacement of a vertex in one iteration [m].
struct MoveLimits {
    double near_bodies = 0.02;  ///< Of a vertex that has a contact plane: what is known of its body reaches no further.
    double elsewhere = 0.1;     ///< Of the others, if there are bodies.
};

// Limits on where an iteration may move the cloth. Directions are planes like pos, 0 at pinned vertices [m].

/// The largest displacement of a vertex [m].
double largest_move(const State& state, const std::vector<real>& direction);

/// The largest fraction of the direction that keeps the limits, at most 1.
double longest_fraction(const System& system, const MoveLimits& limits, const std::vector<real>& direction);

/// Shortens the displacement of each vertex that would pass its contact plane, where bodies exert forces.
void keep_outside_bodies(const System& system, std::vector<real>& direction);

/// Limits the way to a first guess of a step: outside bodies, and through no cloth.
void limit_guess(System& system, const MoveLimits& limits, std::vector<real>& direction);

/// Limits a direction of descent likewise. Vertices are held back one by one where that leaves the direction one of
/// descent; where it does not, the direction is shortened as a whole.
/// @param downhill    minus the gradient of what descends, planes like pos
/// @param unlimited   receives the direction as it was
void limit_descent(System& system, const MoveLimits& limits, const std::vector<real>& downhill,
                   std::vector<real>& direction, std::vector<real>& unlimited);

}  // namespace selvage
