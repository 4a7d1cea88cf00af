#pragma once
#include <string>
#include <vector>

#include "io/geometry.hpp"

namespace selvage {

/// A square sheet of 9 vertices a side that starts level, held along one edge, and swings down until a rigid one would
/// hang. Steps that suit the one are far too long for the other: sheets are from 16 to 400 mm long.
struct MotionModel {
    double stretch = 100;   ///< Stiffness [N/m].
    double bending = 1e-7;  ///< Rigidity [N m].
    double edge = 0.01;     ///< Length of its edges [m].

    double side() const { return 8 * edge; }  ///< [m]
    double until() const;                     ///< When the motion ends [s].
};

/// One run of the map.
struct MotionCell {
    MotionModel model;
    std::string integrator;
    double step = 0.01;  ///< solver.step [s]
};

/// What a user gets from a run.
enum class MotionVerdict {
    accurate,  ///< Within MotionTuning::accurate of the reference.
    rough,     ///< Within MotionTuning::garbage, without a word.
    said,      ///< Refused, given up, or ended with a warning.
    silent     ///< Farther off, and nothing said: there must be none.
};
constexpr int motion_verdicts = 4;

/// Where a sheet is at the end of its motion, by two integrators in steps far below those that are judged.
struct MotionReference {
    std::vector<Vec3> positions;  ///< By rk4.
    std::vector<Vec3> other;      ///< By velocity_verlet: the reference of runs by rk4.
    double difference = 0;        ///< Between the two [1], as MotionResult::error.
};

struct MotionResult {
    MotionCell cell;
    MotionVerdict verdict = MotionVerdict::accurate;
    double error = 0;     ///< Root mean square of the distances to the reference over the side of the sheet [1].
    double estimate = 0;  ///< Largest error of a step that the program tells, likewise; NaN: none.
    int exit_code = 0;
    double seconds = 0;   ///< CPU time of the process [s].
    std::string message;  ///< What the run has said.
};

const char* name_of(MotionVerdict verdict);

/// Returns the sheets of the map.
std::vector<MotionModel> motion_models(bool quick);

/// Returns the runs of one sheet: every integrator, steps from 0.1 to 33 ms.
std::vector<MotionCell> motion_cells(const MotionModel& model);

/// @throws std::runtime_error if no reference is found
MotionReference motion_reference(const MotionModel& model);

/// Runs `drape` in a process of its own, so that its exit code, its words and its last frame are what a user gets.
MotionResult run_motion(const MotionCell& cell, const MotionReference& reference);

}  // namespace selvage
