#pragma once
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "host/run/measure.hpp"
#include "host/run/progressive.hpp"
#include "host/run/run_findings.hpp"
#include "host/scene/plan.hpp"
#include "host/scene/run_settings.hpp"
#include "host/scene/scene_model.hpp"
#include "host/solver/stepping/step_control.hpp"
#include "io/run/checkpoint.hpp"
#include "io/run/progress.hpp"
#include "io/run/run_folder.hpp"
#include "io/run/summary.hpp"
#include "io/run/trajectory.hpp"

namespace selvage {

/// What a run counts from its first to its last step, over all resumptions.
struct RunCounters {
    int steps = 0;
    int newton_iterations = 0;
    int linear_iterations = 0;
    double simulated = 0;                  ///< All phases [s].
    std::map<std::string, double> phases;  ///< Wall seconds of each phase.
    std::vector<std::string> integrators;  ///< That have moved the cloth while it draped, in their order.
    MotionAccuracy accuracy;               ///< Of the steps of a timed motion.
    FaceStretch largest;                   ///< Stretch after any step of the drape.
};

/// What has happened since the last frame was written.
struct FrameProgress {
    int iterations = 0;    ///< Of Newton's method.
    bool relaxed = false;  ///< By static iterations, which take no simulated time.
};

/// The end of a run, as its pictures and measures look at it.
struct LastState {
    std::vector<Vec3> positions;  ///< Of the cloth [m].
    std::vector<Face> faces;      ///< See shared_faces.
    std::vector<TriangleMesh> bodies;
};

/// Writes what a run leaves in its folder.
class RunRecorder {
public:
    /// @param folder  outlives the recorder
    /// @param resume  keep what an earlier run left and append to it
    /// @throws InputError if a file in the folder cannot be removed or written
    RunRecorder(const RunSettings& settings, const SceneModel& model, RunFolder& folder, bool quiet, bool resume);
    ~RunRecorder();

    /// Opens the trajectory of a phase: sewing.h5 with the panels apart, or run.h5 with sewn vertices shared.
    /// @param keep_frames  frames of an earlier run to keep; -1: start anew
    void open_phase(RunStage stage, const Topology& topology, int keep_frames);
    /// Closes the trajectory of the phase that has ended.
    void close_phase();

    /// Tells the user where the run stands.
    void report(RunStage stage, const StepEvent& event, int steps);
    /// Writes a line of text for the user.
    void say(const std::string& text) { progress_->message(text); }
    /// The same for what must be known, also if the run is quiet.
    void warn(const std::string& text) { progress_->warning(text); }
    /// Writes what was found as warnings, also if the run is quiet; notes are left out.
    void warn(const std::vector<Finding>& findings);
    /// Writes a frame if one is due at this time, or if `force` and the cloth has moved since the last one.
    void write_frame(Phase& phase, const StepEvent& event, double wall_seconds, bool force);
    const FrameProgress& frame_progress() const { return since_frame_; }
    void set_frame_progress(const FrameProgress& progress) { since_frame_ = progress; }
    int frame_count() const { return trajectory_ ? trajectory_->frame_count() : 0; }

    /// Returns where cloth and bodies are.
    /// @param bodies_time  at which the bodies are shown [s]
    LastState last_state(const std::vector<Body>& bodies, double time, const Phase& phase) const;
    /// Writes final.obj, body.obj and preview.png.
    /// @returns false if a signal has broken the picture off
    bool show_last(const LastState& last, const Topology& topology);
    /// Writes summary.json, the last file of a run.
    /// @returns what is wrong with the end of the run; the user has been warned of it
    std::vector<Finding> conclude(RunStatus status, const LastState& last, Phase& phase, const RunPlan& plan,
                                  const BodyQuery* query, const RunCounters& counters, const StabilityUse& stability,
                                  const std::vector<CoarseStage>& coarse_stages, const Profile& profile,
                                  double residual, double wall_seconds, const std::string& message);

private:
    double frame_time_after(double time) const;
    std::string trajectory_path();
    void follow_folder();
    void write_meshes(const LastState& last, const Topology& topology);
    EndCrossings find_crossings(const LastState& last) const;
    bool draw(const LastState& last, const Topology& topology);

    const RunSettings& settings_;
    const SceneModel& model_;
    RunFolder& folder_;
    std::string shown_folder_;  ///< Where the user knows it to be.
    std::optional<TrajectoryWriter> trajectory_;
    std::unique_ptr<ProgressReport> progress_;
    double next_frame_ = 0;   ///< Simulated time at which the next frame is due [s].
    double last_frame_ = -1;  ///< Time of the last written frame [s].
    int frames_ = 0;          ///< Of run.h5.
    FrameProgress since_frame_;
    bool sewing_phase_ = false;
};

}  // namespace selvage
