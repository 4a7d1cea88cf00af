#pragma once
#include <functional>
#include <string>

#include "io/run/summary.hpp"

namespace selvage {

struct Scene;

struct RunOptions {
    std::string folder = "out";  ///< Where the results go; made if missing.
    bool resume = false;         ///< Go on from the folder's checkpoint.
    bool quiet = false;          ///< No progress on stderr.
    std::string notice = {};     ///< Said once the run begins, also if it is quiet.
    /// Called after each checkpoint; false stops the run there. For tests of what a resumed run does.
    std::function<bool()> after_checkpoint = {};
    bool profile = false;  ///< Print what every phase cost, and leave trace.json.
};

struct RunOutcome {
    RunStatus status = RunStatus::finished;
    int exit_code = 0;
    std::string message;      ///< For stderr; empty when there is nothing to say.
    std::string folder = {};  ///< Where the results are at the end: it may have been moved meanwhile.
};

/// Sews and drapes a scene and writes trajectory, summary, last frame, picture and checkpoints into the folder.
/// Sewing runs without gravity until every seam is closed; then sewn vertices become one particle and the garment is
/// draped, to equilibrium or for a given time.
/// With `resume` the run goes on from its checkpoint: docs/resume.md. One that has left none starts from the beginning;
/// of one that has ended, nothing is touched.
/// @throws InputError for a faulty scene, a scene too large for the memory, a checkpoint that is damaged or of another
///         scene, or a folder that another run writes to; WriteError when a file cannot be written
RunOutcome run_drape(const Scene& scene, const RunOptions& options);

}  // namespace selvage
