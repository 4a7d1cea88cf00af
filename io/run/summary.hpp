#pragma once
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "io/words.hpp"

namespace selvage {

/// How a run ended.
#define RUN_STATUSES(WORD) WORD(converged) WORD(finished) WORD(time_limit) WORD(diverged) WORD(interrupted)
WORD_ENUM(RunStatus, RUN_STATUSES)

/// Whether the run came to its end: at rest, or at the time that it was asked for.
constexpr bool is_complete(RunStatus status) { return status == RunStatus::converged || status == RunStatus::finished; }

/// Returns the status that a summary.json tells, or nothing if there is no such file, or it is none.
std::optional<RunStatus> read_status(const std::string& path);

/// The use of one kernel over a whole run.
struct KernelUse {
    std::string name;
    std::int64_t calls = 0;
    double seconds = 0;            ///< Wall time.
    double processor_seconds = 0;  ///< Of all threads.
    std::int64_t items = 0;        ///< Items processed in all calls.
    std::int64_t bytes = 0;        ///< Bytes read and written in all calls.
};

/// A feature that did not run, with the reason.
struct SkippedPart {
    std::string name;
    std::string reason;
};

/// The distortion of one panel at the end of a run.
struct PanelFit {
    std::string name;
    double area_error;      ///< Relative change of area against the flat panel [1].
    double boundary_error;  ///< Relative change of boundary length against the flat panel [1].
};

/// The use of one of the coarser meshes on which the cloth was draped first.
struct CoarseUse {
    int vertices = -1, newton_iterations = -1, linear_iterations = -1;
    double residual, seconds;
    int intersections = 0;  ///< Self-intersections of its shape, interpolated to the finer mesh.
    bool used = true;       ///< False: it diverged (no residual), or its shape passes through itself on the finer mesh.
};

/// The steps of an explicit integrator and its stability limit; NaN: no limit.
struct StabilityUse {
    static constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
    double asked = unknown;  ///< The requested step, solver.step [s].
    double limit = unknown;  ///< The lowest stability limit of the run [s].
    double taken = unknown;  ///< The shortest step of the run [s].
};

/// How well the steps of a timed motion were solved, and what their lengths cost.
struct MotionAccuracy {
    int steps = 0;             ///< That were to be solved.
    int unsolved = 0;          ///< Of them that left more than solver.step_tolerance.
    double largest_left = 0;   ///< Acceleration that a step has not found, over gravity [1].
    double left_time = 0;      ///< When that was [s].
    double sum_left = 0;       ///< Over all of these steps.
    int estimates = 0;         ///< Steps whose error in time the integrator has estimated.
    double largest_error = 0;  ///< Of one of them [m].
    double error_time = 0;     ///< When that was [s].
    double sum_error = 0;      ///< Over all of them [m].
};

/// The contents of summary.json. An unknown number is NaN, or negative if it is a count, and is written as null.
struct RunSummary {
    static constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

    RunStatus status = RunStatus::finished;
    std::string message;  ///< One sentence for the user; may be empty.
    std::string scene, version, precision;
    int threads = -1, vertices = -1, triangles = -1;
    std::int64_t steps = -1, frames = -1, newton_iterations = -1, linear_iterations = -1;
    double simulated_s = unknown, wall_s = unknown;
    std::vector<std::pair<std::string, double>> phases;  ///< Name and wall time [s] of each phase, in order.
    std::vector<KernelUse> kernels;
    std::vector<std::string> integrators;  ///< That moved the cloth while it draped, in their order.
    std::vector<std::string> active;       ///< Terms and stages that ran.
    std::vector<SkippedPart> skipped;
    std::vector<std::string> warnings;
    std::int64_t peak_memory_bytes = -1;
    StabilityUse stability;
    MotionAccuracy accuracy;
    double step_tolerance = unknown;      ///< solver.step_tolerance [1].
    std::vector<CoarseUse> coarse_start;  ///< Coarsest mesh first; empty: no coarser mesh was used.
    double residual = unknown;            ///< Relative force residual at the end.
    struct Energy {
        double membrane = unknown, bending = unknown, gravity = unknown, contact = unknown, kinetic = unknown;
    } energy;  ///< [J]
    struct Stretch {
        double min = unknown, max = unknown, p99 = unknown;
        double largest = unknown, largest_time = unknown;  ///< Over the whole drape, and when that was [s].
        std::string largest_panel;
        int largest_triangle = -1;  ///< Of the cloth.
    } stretch;                      ///< Principal stretch - 1; the first three of the last frame.
    double body_max_penetration = unknown, body_min_gap = unknown;  ///< [m]
    std::int64_t self_intersections = -1, body_intersections = -1;  ///< Pairs of triangles in the last frame.
    int seam_count = -1;
    double seam_max_gap = unknown;  ///< [m]
    struct SeamGap {
        std::string sides[2];  ///< Panel and edge.
        std::string place;     ///< Of the stitch in the pattern.
        double gap = 0;        ///< [m]
    };
    std::vector<SeamGap> open_seams;  ///< In the last frame, the widest first.
    std::vector<PanelFit> panels;
};

/// Returns the summary as JSON text.
std::string summary_json(const RunSummary& summary);

/// Writes the summary under a temporary name and moves it into place, so the file exists only if the run ended.
/// @throws InputError if the folder cannot be written.
void write_summary(const std::string& path, const RunSummary& summary);

}  // namespace selvage
