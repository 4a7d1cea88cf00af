#pragma once
#include <optional>
#include <string>

#include "host/collision/cloth_tree.hpp"
#include "io/errors.hpp"

namespace selvage {

/// Why a step failed.
enum class StepFault {
    not_finite,     ///< A position, a velocity or the residual is infinite or no number.
    blocked,        ///< Bodies or held vertices did not get to where they were to be: cloth is in their way.
    passed,         ///< The cloth passed through itself, or an edge or corner of a body through it.
    stuck,          ///< Newton's method found no direction that leads down.
    unsolved,       ///< Newton's iterations ended above their tolerance.
    entered_body,   ///< A vertex passed into a body.
    gained_energy,  ///< The scheme made energy from nothing.
    unstable,       ///< The stability limit of an explicit scheme fell away.
};

/// What is known of the last attempt at a step that failed at every length.
struct StepFailure {
    StepFault fault = StepFault::unsolved;
    double step = 0;       ///< Of that attempt [s].
    double longest = 0;    ///< That was asked for [s].
    double residual = 0;   ///< Of that attempt, relative to the weight [1].
    int particle = -1;     ///< Where it shows: the first that is not finite, or the one with the most force; -1: none.
    double net_force = 0;  ///< On it [N].
    std::optional<PairCandidate> obstacle = {};  ///< The pair that bodies or held vertices would pass through first.
    std::string obstacle_body = {};              ///< The body of that pair; empty: none.
    Vec3 obstacle_point = Vec3::Zero();          ///< Where its first side is nearest to the second [m].
};

/// Thrown where no step succeeds.
class StepFailureError : public DivergenceError {
public:
    explicit StepFailureError(StepFailure known);
    StepFailure failure;
};

}  // namespace selvage
