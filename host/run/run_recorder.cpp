#include "host/run/run_recorder.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>

#include <tbb/global_control.h>

#include "host/mesh/self_intersections.hpp"
#include "host/model/body.hpp"
#include "host/model/cloth_place.hpp"
#include "host/run/cloth_picture.hpp"
#include "host/run/interrupt.hpp"
#include "host/run/measure.hpp"
#include "io/errors.hpp"
#include "io/memory.hpp"
#include "io/mesh/mesh_obj.hpp"
#include "io/scene/presets.hpp"
#include "io/version.hpp"

namespace selvage {
namespace {

// An interrupted run still gets its picture if that takes no longer: whoever sends SIGTERM may send SIGKILL soon.
// Chosen by hand; the default picture of the default scene takes less than that.
constexpr std::chrono::seconds picture_of_interrupted{2};

// All that a run leaves but progress.jsonl, which is never renamed.
const std::vector<std::string> results = {"summary.json", "run.h5",        "run.vtkhdf",    "run.xdmf",
                                          "sewing.h5",    "sewing.vtkhdf", "sewing.xdmf",   "final.obj",
                                          "preview.png",  "body.obj",      "checkpoint.h5", "trace.json"};

TrajectoryLayout trajectory_layout(const RunSettings& settings, const Cloth& cloth, const Topology& topology)
{
    TrajectoryLayout layout;
    layout.point_count = int(cloth.positions.size());
    layout.triangles = shared_faces(cloth, topology);
    layout.panel_coordinates = cloth.panel_coordinates;
    for (int p = 0; p < int(cloth.panels.size()); ++p) {
        layout.panel.insert(layout.panel.end(), std::size_t(cloth.panels[p].vertex_count), p);
        layout.panel_names.push_back(cloth.panels[p].name);
    }
    layout.rest_edge_lengths = rest_edge_lengths(cloth);
    layout.rest_corners = rest_corners(cloth);
    layout.triangle_panel = face_panels(cloth);
    layout.seam_pairs = cloth.seam_pairs;
    layout.scene_text = settings.text;
    const bool builtin = is_builtin(settings.file);
    layout.scene_file = builtin ? settings.file : std::filesystem::absolute(settings.file).string();
    layout.version = version;
    layout.grid = settings.output.precision;
    return layout;
}

// Of the cloth in its last state.
void add_measures(RunSummary& s, const Cloth& cloth, const Phase& phase, const std::vector<Vec3>& positions,
                  const BodyQuery* query)
{
    const Energies energies = phase.system().energies();
    s.energy = {energies.membrane, energies.bending, energies.gravity, energies.contact, energies.kinetic};
    if (query && !query->empty()) {
        const State& state = phase.state();
        const BodyGap gap = query->measure(state.pos.data(), state.size.vertex_stride, state.size.vertex_count);
        s.body_max_penetration = gap.max_penetration_m;
        s.body_min_gap = gap.min_gap_m;
    }
    s.seam_count = int(cloth.seams.size());
    if (!cloth.seams.empty()) s.seam_max_gap = measure_seam_gap(cloth, positions);
    for (const OpenSeam& open : open_seams(cloth, positions)) {
        const auto [one, other] = seam_sides(cloth, open.seam);
        s.open_seams.push_back({{one, other}, describe(cloth.seams[open.seam].place), open.gap});
    }
    for (const PanelMeasure& p : measure_panels(cloth, positions))
        s.panels.push_back({p.name, p.area_error, p.boundary_error});
}

void add_largest_stretch(RunSummary& s, const Cloth& cloth, const FaceStretch& largest)
{
    if (largest.face < 0) return;
    s.stretch.largest = largest.stretch;
    s.stretch.largest_time = largest.time;
    s.stretch.largest_triangle = largest.face;
    s.stretch.largest_panel = panel_of_face(cloth, largest.face).name;
}

}  // namespace

RunRecorder::RunRecorder(const RunSettings& settings, const SceneModel& model, RunFolder& folder, bool quiet,
                         bool resume)
    : settings_(settings), model_(model), folder_(folder), shown_folder_(folder.path())
{
    folder_.remove_temporary_files(results);
    if (!resume)
        for (const std::string& stale : results) folder_.remove(stale);
    folder_.remove("summary.json");
    ProgressOptions progress;
    progress.path = folder_.path() + "/progress.jsonl";
    progress.append = resume;
    progress.quiet = quiet;
    progress.tolerance = settings.drape.tolerance;
    if (!settings.until.equilibrium) progress.end_time = settings.until.time;
    progress_ = std::make_unique<ProgressReport>(progress);
}

RunRecorder::~RunRecorder() = default;

std::string RunRecorder::trajectory_path() { return folder_.path() + (sewing_phase_ ? "/sewing.h5" : "/run.h5"); }

// The trajectory stays open when its folder is moved; what is written beside it has to go along.
void RunRecorder::follow_folder()
{
    if (folder_.path() == shown_folder_) return;
    shown_folder_ = folder_.path();
    trajectory_->moved_to(trajectory_path());
    say("the folder of the results has been moved: it is now " + shown_folder_);
}

void RunRecorder::open_phase(RunStage stage, const Topology& topology, int keep_frames)
{
    sewing_phase_ = stage == RunStage::sew;
    last_frame_ = -1;
    next_frame_ = 0;
    if (sewing_phase_ && !settings_.output.sewing) return;
    const std::string path = trajectory_path();
    if (keep_frames >= 0)
        trajectory_.emplace(TrajectoryWriter::resume(path, keep_frames));
    else
        trajectory_.emplace(
            TrajectoryWriter::create(path, trajectory_layout(settings_, model_.cloth_model.cloth, topology)));
    if (!trajectory_->has_second_name())
        say(path + " has no second name with the ending .vtkhdf: the file system has no hard links");
    if (keep_frames > 0) {
        last_frame_ = trajectory_->last_time();
        next_frame_ = frame_time_after(last_frame_);
    }
}

double RunRecorder::frame_time_after(double time) const
{
    const double interval = 1 / settings_.frame_rate;
    return interval * (std::floor(time / interval + 1e-6) + 1);
}

void RunRecorder::close_phase()
{
    if (!trajectory_) return;
    follow_folder();
    trajectory_->finish();
    if (!sewing_phase_) frames_ = trajectory_->frame_count();
    trajectory_.reset();
}

void RunRecorder::report(RunStage stage, const StepEvent& event, int steps)
{
    ProgressState state;
    state.phase = word_of(stage);
    state.time = event.time;
    state.step = steps;
    state.frames = frame_count();
    if (!sewing_phase_) state.residual = event.residual;  // while sewing it is a gap
    if (event.left >= 0) state.left = event.left;
    if (event.error >= 0) state.error = event.error;
    progress_->update(state);
}

void RunRecorder::write_frame(Phase& phase, const StepEvent& event, double wall_seconds, bool force)
{
    since_frame_.iterations += event.newton_iterations;
    since_frame_.relaxed = since_frame_.relaxed || (event.dt == 0 && event.newton_iterations > 0);
    const double interval = 1 / settings_.frame_rate;
    const bool due = settings_.output.frames && event.dt > 0 && event.time >= next_frame_ - 1e-9;
    const bool moved = event.time > last_frame_ || since_frame_.relaxed;
    if (!trajectory_ || !(due || (force && moved))) return;
    const TraceScope scope("write_frame");
    follow_folder();
    FrameScalars scalars;
    scalars.time = event.time > last_frame_ ? event.time : last_frame_ + interval;
    scalars.kinetic_energy = phase.system().kinetic_energy();
    scalars.total_energy = phase.system().potential_energy() + scalars.kinetic_energy;
    scalars.residual = event.residual;
    scalars.wall_seconds = wall_seconds;
    scalars.contacts = phase.contact() ? phase.contact()->contact_count() : 0;
    scalars.iterations = since_frame_.iterations;
    trajectory_->write_frame(phase.positions(), scalars);
    since_frame_ = {};
    last_frame_ = scalars.time;
    next_frame_ = frame_time_after(scalars.time);
}

void RunRecorder::write_meshes(const LastState& last, const Topology& topology)
{
    const Cloth& cloth = model_.cloth_model.cloth;
    std::vector<std::vector<Face>> faces(cloth.panels.size());
    const std::vector<Face> outward = outward_faces(cloth);
    std::vector<ObjObject> objects;
    std::vector<int> repeated = representatives(topology);
    for (int v = 0; v < int(repeated.size()); ++v)
        if (repeated[v] == v) repeated[v] = -1;
    for (int p = 0; p < int(cloth.panels.size()); ++p) {
        const ClothPanel& panel = cloth.panels[p];
        for (int f = panel.first_face; f < panel.first_face + panel.face_count; ++f) {
            Face face = outward[f];
            for (int& v : face) v -= panel.first_vertex;
            faces[p].push_back(face);
        }
        const auto range = [&](const auto& all) {
            return std::span(all).subspan(panel.first_vertex, panel.vertex_count);
        };
        objects.push_back(
            {panel.name, range(last.positions), faces[p], range(cloth.panel_coordinates), range(repeated)});
    }
    folder_.write([&](const std::string& folder) { write_obj(folder + "/final.obj", objects); });
    if (last.bodies.empty()) return;
    objects.clear();
    for (std::size_t b = 0; b < last.bodies.size(); ++b)
        objects.push_back({model_.cloth_model.bodies[b].name, last.bodies[b].vertices, last.bodies[b].faces});
    folder_.write([&](const std::string& folder) { write_obj(folder + "/body.obj", objects); });
}

bool RunRecorder::draw(const LastState& last, const Topology& topology)
{
    if (!settings_.output.picture) return true;
    const TraceScope scope("picture");
    PictureOptions options;
    options.width = settings_.output.picture_width;
    options.samples_per_axis = settings_.output.picture_samples;
    options.stop = [came_before = interrupt_requested(), began = std::chrono::steady_clock::now()] {
        return interrupt_requested() &&
               (!came_before || std::chrono::steady_clock::now() - began > picture_of_interrupted);
    };
    const Image image =
        draw_cloth(model_.cloth_model.cloth, last.bodies, last.positions, last.faces, topology, options);
    if (image.width == 0) return false;
    const TraceScope encoding("opencv");
    folder_.write([&](const std::string& folder) { write_png(folder + "/preview.png", image); });
    return true;
}

LastState RunRecorder::last_state(const std::vector<Body>& bodies, double time, const Phase& phase) const
{
    LastState last{phase.positions(), shared_faces(model_.cloth_model.cloth, phase.topology()), {}};
    for (const Body& body : bodies) last.bodies.push_back(body_mesh_at(body, time));
    return last;
}

bool RunRecorder::show_last(const LastState& last, const Topology& topology)
{
    write_meshes(last, topology);
    return draw(last, topology);
}

void RunRecorder::warn(const std::vector<Finding>& findings)
{
    for (const Finding& finding : findings)
        if (finding.severity != Severity::note)
            progress_->warning(text_of(finding.severity) + ": " + describe(finding));
}

// Of the last frame as it is written, where the files allow it to be looked at again.
EndCrossings RunRecorder::find_crossings(const LastState& last) const
{
    const TraceScope scope("find_crossings");
    const double spacing = grid_spacing(settings_.output.precision);
    EndCrossings crossings;
    for (const Vec3& x : last.positions) crossings.positions.push_back(written_position(x, spacing).cast<double>());
    const auto is_finite = [](const Vec3& x) { return x.allFinite(); };
    if (!std::all_of(crossings.positions.begin(), crossings.positions.end(), is_finite)) return crossings;
    crossings.counted = true;
    crossings.self = self_intersections(crossings.positions, last.faces);
    for (const TriangleMesh& body : last.bodies)
        crossings.with_body.push_back(mutual_intersections(crossings.positions, last.faces, body));
    return crossings;
}

std::vector<Finding> RunRecorder::conclude(RunStatus status, const LastState& last, Phase& phase, const RunPlan& plan,
                                           const BodyQuery* query, const RunCounters& counters,
                                           const StabilityUse& stability, const std::vector<CoarseStage>& coarse_stages,
                                           const Profile& profile, double residual, double wall_seconds,
                                           const std::string& message)
{
    const Cloth& cloth = model_.cloth_model.cloth;
    RunSummary s;
    s.status = status;
    s.scene = settings_.name;
    s.version = version;
    s.precision = word_of(settings_.precision);
    s.message = message;
    s.threads = int(tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism));
    s.vertices = phase.state().size.vertex_count;
    s.triangles = int(cloth.faces.size());
    s.steps = counters.steps;
    s.frames = frames_;
    s.newton_iterations = counters.newton_iterations;
    s.linear_iterations = counters.linear_iterations;
    s.simulated_s = counters.simulated;
    for (const auto& [name, seconds] : counters.phases) s.phases.push_back({name, seconds});
    for (const KernelRecord& k : profile.records())
        s.kernels.push_back({k.name, k.calls, k.spent.wall, k.spent.processor, k.items, k.bytes});
    s.integrators = counters.integrators;
    s.active = plan.active;
    for (const SkippedFeature& f : plan.skipped) s.skipped.push_back({f.name, f.reason});
    s.stability = stability;
    s.accuracy = counters.accuracy;
    s.step_tolerance = settings_.drape.step_tolerance;
    for (const CoarseStage& c : coarse_stages)
        s.coarse_start.push_back({c.vertices, c.newton_iterations, c.linear_iterations, c.residual, c.wall_seconds,
                                  c.intersections, c.used});
    s.residual = residual;
    add_measures(s, cloth, phase, last.positions, query);
    FaceStretch largest = counters.largest;
    const EndCrossings crossings = find_crossings(last);
    if (crossings.counted) {
        const StretchMeasure stretch = measure_stretch(rest_corners(cloth), last.faces, crossings.positions);
        if (largest.face < 0 || stretch.max > largest.stretch)
            largest = {stretch.max, stretch.max_face, phase.system().clock().time};
        s.stretch.min = stretch.min;
        s.stretch.max = stretch.max;
        s.stretch.p99 = stretch.p99;
        s.self_intersections = std::int64_t(crossings.self.size());
    }
    add_largest_stretch(s, cloth, largest);
    if (crossings.counted && !last.bodies.empty()) s.body_intersections = crossings.count_with_bodies();
    std::vector<Finding> at_end = find_end_crossings(model_.cloth_model, crossings);
    if (is_complete(status)) append_findings(at_end, find_lost_garment(model_.cloth_model, phase, last.positions));
    append_findings(at_end, find_long_steps(counters.accuracy, last.positions));
    warn(at_end);
    std::vector<Finding> told = model_.findings;
    append_findings(told, at_end);
    for (const Finding& finding : told)
        if (finding.severity != Severity::note) s.warnings.push_back(describe(finding));
    s.peak_memory_bytes = peak_memory_bytes();
    s.wall_s = wall_seconds;
    folder_.write([&](const std::string& folder) { write_summary(folder + "/summary.json", s); });
    return at_end;
}

}  // namespace selvage
