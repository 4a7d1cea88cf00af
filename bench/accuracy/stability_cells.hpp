#pragma once
#include <string>
#include <vector>

namespace selvage {

/// The initial state of a sheet; it always starts above a sphere, on which it falls.
enum class ViolentStart { crumpled, stretched, hurled };

/// One run of the grid.
struct StabilityCell {
    std::string integrator;
    double step = 0.01;    ///< Requested step [s].
    double stiffness = 1;  ///< Times cotton's, stretch and bending [1].
    int resolution = 16;   ///< Vertices per side.
    double damping = 0;    ///< [1/s]
    ViolentStart start = ViolentStart::crumpled;
    bool self_contact = false;  ///< Contact of the cloth with itself.
};

/// How a run of the grid ended.
enum class StabilityVerdict {
    stable,     ///< Every step had the requested length.
    recovered,  ///< Some steps failed and were repeated with shorter ones.
    refused,    ///< The step is above the explicit limit: the run did not start, and its message names the limit.
    gave_up,    ///< The run stopped with a message and kept its last good state.
    slow,       ///< The run was stopped after 20 s of CPU time; its steps were good.
    hung,       ///< A single step took longer than a minute.
    garbage     ///< Not finite, 1.5 times the energy of the start and of gravity, or cloth that passed through itself.
};
constexpr int verdict_count = 7;

struct StabilityResult {
    StabilityCell cell;
    StabilityVerdict verdict = StabilityVerdict::stable;
    double energy_ratio = 0;  ///< Energy at the end over that at the start, both with what gravity could supply [1].
    double seconds = 0;       ///< CPU time of the steps, by thread_seconds() [s].
    int tangled = 0;          ///< Pairs of triangles that intersect at the start, by exact predicates.
    int crossed = 0;          ///< The same at the end; neither is counted without self_contact.
    std::string message;
};

/// The predicted stability limit of an explicit integrator, and the measured step at which small motions start to grow.
struct LimitResult {
    std::string integrator;
    double stiffness;
    int resolution;
    double predicted, measured;  ///< [s]
};

const char* name_of(ViolentStart start);
const char* name_of(StabilityVerdict verdict);

/// Returns all cells, more than 2000; finer resolutions and contact of the cloth with itself have fewer of them.
/// @param quick  only the coarsest resolution, without contact of the cloth with itself
std::vector<StabilityCell> stability_cells(bool quick);

/// Takes ten steps of a cell, or four above 32 vertices per side. A run that fails does not throw.
StabilityResult run_cell(const StabilityCell& cell);

/// Finds the measured limit by bisection between half and twice the predicted one.
LimitResult measure_limit(const std::string& integrator, double stiffness, int resolution);

}  // namespace selvage
