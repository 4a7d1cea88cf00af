#include "host/run/ended_run.hpp"

#include <filesystem>

#include "host/scene/scene_values.hpp"
#include "io/errors.hpp"
#include "io/run/trajectory.hpp"
#include "io/scene/read_scene.hpp"

namespace selvage {
namespace {

std::optional<RunStatus> status_in(const std::string& folder) { return read_status(folder + "/summary.json"); }

}  // namespace

bool has_checkpoint(const std::string& folder)
{
    std::error_code error;
    return std::filesystem::exists(std::filesystem::symlink_status(folder + "/checkpoint.h5", error));
}

bool has_ended(const std::string& folder)
{
    std::error_code error;
    const std::optional<RunStatus> status = status_in(folder);
    return status && is_complete(*status) && std::filesystem::exists(folder + "/run.h5", error);
}

bool is_done(const Scene& scene, const std::string& folder)
{
    if (!has_ended(folder)) return false;
    const std::string path = folder + "/run.h5";
    const TrajectoryReader run(path);
    const Scene before = read_scene_text(run.layout().scene_text, run.layout().scene_file);
    const std::string differing = differing_values(scene_values(scene), scene_values(before));
    if (!differing.empty())
        throw InputError({path, 0, 0, {}}, "the results of another scene (" + differing + ")",
                         "those of this scene; run without --resume to start anew");
    if (before.solver.until != scene.solver.until)
        throw InputError(scene.place("solver.until"), "`" + scene.solver.until + "`",
                         "`" + before.solver.until + "`, to which the run in " + folder +
                             " came without leaving a checkpoint (output.keep_checkpoint keeps it)");
    return true;
}

RunOutcome nothing_left(const std::string& folder)
{
    RunOutcome outcome;
    outcome.status = status_in(folder).value_or(RunStatus::finished);
    outcome.folder = folder;
    outcome.message =
        folder + ": the run has come to its end (" + text_of(outcome.status) + "): there is nothing left to do";
    return outcome;
}

}  // namespace selvage
