#pragma once
#include <string>
#include <vector>

namespace selvage {

/// How a sheet starts, each time above a sphere that it meets.
enum class ViolentStart { crumpled, stretched, hurled };

/// One run of the grid.
struct StabilityCell {
    std::string integrator;
    double step = 0.01;    ///< Asked [s].
    double stiffness = 1;  ///< Times cotton's, stretch and bending [1].
    int resolution = 16;   ///< Vertices per side.
    double damping = 0;    ///< [1/s]
    ViolentStart start = ViolentStart::crumpled;
    bool self_contact = false;  ///< Contact of the cloth with itself.
};

/// What became of it.
enum class StabilityVerdict {
    stable,     ///< Every step as asked.
    recovered,  ///< Some steps failed and were taken in shorter ones.
    refused,    ///< Above the explicit limit: not begun, with a message that names the limit.
    gave_up,    ///< Stopped with a message, the last good state kept.
    slow,       ///< Stopped by its limit of 20 s, its steps being good.
    hung,       ///< A single step took longer than a minute.
    garbage     ///< Not finite, with half more energy than it started with or gravity gave, or passed through itself.
};
constexpr int verdict_count = 7;

struct StabilityResult {
    StabilityCell cell;
    StabilityVerdict verdict = StabilityVerdict::stable;
    double energy_ratio = 0;  ///< Energy at the end over what was there to begin with [1].
    double seconds = 0;       ///< That the steps took, by thread_seconds() [s].
    int tangled = 0;          ///< Pairs of triangles that intersect at the start, by exact predicates.
    int crossed = 0;          ///< Those at the end; neither is counted without self_contact.
    std::string message;
};

/// The predicted limit of an explicit integrator against the one at which small motions begin to grow.
struct LimitResult {
    std::string integrator;
    double stiffness;
    int resolution;
    double predicted, measured;  ///< [s]
};

const char* name_of(ViolentStart start);
const char* name_of(StabilityVerdict verdict);

/// All cells: more than 2000, fewer at the finer resolutions and with contact of the cloth with itself.
/// @param quick  only the coarsest, without that contact
std::vector<StabilityCell> stability_cells(bool quick);

/// Takes ten steps of a cell, four of the finer ones. Never throws for a run that fails.
StabilityResult run_cell(const StabilityCell& cell);

/// Finds the limit by bisection.
LimitResult measure_limit(const std::string& integrator, double stiffness, int resolution);

}  // namespace selvage
