#pragma once
#include <cstdint>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace selvage {

/// How a run ended.
enum class RunStatus { converged, finished, time_limit, diverged, interrupted };

/// The word for a status in summary.json, such as `time_limit`.
std::string status_name(RunStatus status);

struct KernelUse {
    std::string name;
    std::int64_t calls = 0;
    double seconds = 0;
    std::int64_t items = 0;  ///< Over all calls.
    std::int64_t bytes = 0;  ///< Read and written over all calls.
};

struct SkippedPart {
    std::string name;
    std::string reason;
};

struct PanelFit {
    std::string name;
    double area_error;      ///< Relative change of area against the flat panel.
    double boundary_error;  ///< Relative change of boundary length.
};

/// One of the coarser cloths that were draped first.
struct CoarseUse {
    int vertices = -1, newton_iterations = -1, linear_iterations = -1;
    double residual, seconds;
    int intersections = 0;  ///< Of the shape carried over from it.
    bool used = true;       ///< False: it diverged (no residual), or its shape passes through itself on the finer mesh.
};

/// How an explicit integrator's steps stood to its stability limit; NaN: no limit.
struct StabilityUse {
    static constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
    double asked = unknown;  ///< solver.step [s]
    double limit = unknown;  ///< The lowest that was met [s].
    double taken = unknown;  ///< The shortest step [s].
};

/// What summary.json says. A number that is not known is NaN or negative (counts) and becomes null.
struct RunSummary {
    static constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

    RunStatus status = RunStatus::finished;
    std::string message;  ///< One sentence for the user; may be empty.
    std::string scene, version, precision;
    int threads = -1, vertices = -1, triangles = -1;
    std::int64_t steps = -1, frames = -1, newton_iterations = -1, linear_iterations = -1;
    double simulated_s = unknown, wall_s = unknown;
    std::vector<std::pair<std::string, double>> phases;  ///< Name and wall time [s], in order.
    std::vector<KernelUse> kernels;
    std::vector<std::string> active;  ///< Terms and stages that ran.
    std::vector<SkippedPart> skipped;
    std::vector<std::string> warnings;
    std::int64_t peak_memory_bytes = -1;
    StabilityUse stability;
    std::vector<CoarseUse> coarse_start;  ///< Coarsest first; empty: the cloth itself fell from its start.
    double residual = unknown;            ///< Relative force residual at the end.
    struct Energy {
        double membrane = unknown, bending = unknown, gravity = unknown, contact = unknown, kinetic = unknown;
    } energy;  ///< [J]
    struct Stretch {
        double min = unknown, max = unknown, p99 = unknown;
    } stretch;                                                      ///< Principal stretch - 1.
    double body_max_penetration = unknown, body_min_gap = unknown;  ///< [m]
    std::int64_t self_intersections = -1, body_intersections = -1;  ///< Pairs of triangles in the last frame.
    int seam_count = -1;
    double seam_max_gap = unknown;  ///< [m]
    std::vector<PanelFit> panels;
};

/// The summary as JSON text.
std::string summary_json(const RunSummary& summary);

/// Writes it through a temporary name: the file's presence means that the run ended.
/// @throws InputError if the folder cannot be written.
void write_summary(const std::string& path, const RunSummary& summary);

}  // namespace selvage
