#include "host/run/restart.hpp"

#include <cmath>
#include <cstring>
#include <sstream>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "host/model/body.hpp"
#include "host/run/checkpoint_values.hpp"
#include "host/run/phase_memory.hpp"

namespace selvage {
namespace {

// FNV-1a, over the bits of what a model consists of.
class Fingerprint {
public:
    template <class T>
    void add(const T& value)
    {
        unsigned char bytes[sizeof(T)];
        std::memcpy(bytes, &value, sizeof(T));
        for (unsigned char byte : bytes) hash_ = (hash_ ^ byte) * 1099511628211ull;
    }
    void add(const Vec3& x)
    {
        for (int c = 0; c < 3; ++c) add(x[c]);
    }
    std::string text() const { return fmt::format("{:016x}", hash_); }

private:
    unsigned long long hash_ = 14695981039346656037ull;
};

// Names every number of what a run remembers beside the particles. The bindings name all members of a struct, so a new
// one does not compile until it is given a name here.
template <class Memory, class Visit>
void visit_steps(Memory& memory, const std::string& of, const Visit& visit)
{
    auto& [dt, knows_energy, first_energy, highest_kinetic, lowest_potential] = memory;
    visit(of + ".dt", dt);
    visit(of + ".knows_energy", knows_energy);
    visit(of + ".first_energy", first_energy);
    visit(of + ".highest_kinetic", highest_kinetic);
    visit(of + ".lowest_potential", lowest_potential);
}

template <class Progress, class Visit>
void visit_sewing(Progress& sewing, const Visit& visit)
{
    auto& [best_gap, steps_without_gain, elastic_energy, gap, energy_change, steps] = sewing;
    visit("sewing.best_gap", best_gap);
    visit("sewing.steps_without_gain", steps_without_gain);
    visit("sewing.elastic_energy", elastic_energy);
    visit("sewing.gap", gap);
    visit("sewing.energy_change", energy_change);
    visit_steps(steps, "sewing", visit);
}

template <class Progress, class Visit>
void visit_draping(Progress& draping, const Visit& visit)
{
    auto& [switch_residual, hold, residual, steps, load, asleep] = draping;
    visit("draping.switch_residual", switch_residual);
    visit("draping.hold", hold);
    visit("draping.residual", residual);
    visit_steps(steps, "draping", visit);
    visit("draping.load", load);
    visit("draping.asleep", asleep);
}

template <class Progress, class Visit>
void visit_progress(Progress& progress, const Visit& visit)
{
    // The stage is a word; what is not always there has its own functions.
    auto& [stage, sewing, pressing, draping, counters, frame, stability, coarse, ended, wall_seconds, frames] =
        progress;
    visit_sewing(sewing, visit);
    auto& [press_step, press_steps] = pressing;
    visit("pressing.step", press_step);
    visit_steps(press_steps, "pressing", visit);
    visit_draping(draping, visit);
    // Seconds have names of their own, integrators are words.
    auto& [steps, newton_iterations, linear_iterations, simulated, seconds, integrators] = counters;
    visit("counters.steps", steps);
    visit("counters.newton_iterations", newton_iterations);
    visit("counters.linear_iterations", linear_iterations);
    visit("counters.simulated", simulated);
    auto& [iterations_since_frame, relaxed_since_frame] = frame;
    visit("frame.iterations", iterations_since_frame);
    visit("frame.relaxed", relaxed_since_frame);
    visit("ended", ended);
    visit("wall_seconds", wall_seconds);
    visit("frames", frames);
}

constexpr std::string_view seconds_prefix = "seconds.";  // of each phase

void save_stability(const CheckpointSaver& save, const StabilityUse& stability)
{
    const bool known = !std::isnan(stability.limit);
    save("stability",
         known ? std::vector<real>{stability.asked, stability.limit, stability.taken} : std::vector<real>{});
}

StabilityUse stability_of(const CheckpointLoader& load)
{
    if (load.reals("stability").empty()) return {};
    const std::vector<double>& values = load.reals("stability", 3);
    return {values[0], values[1], values[2]};
}

constexpr int coarse_counts = 5, coarse_measures = 2;  // numbers of each coarse stage
constexpr double diverged = -1;                        // in place of its residual

void save_coarse(const CheckpointSaver& save, const CoarseStart& coarse)
{
    std::vector<int> counts;
    std::vector<real> measures;
    for (const CoarseStage& stage : coarse.stages) {
        const auto& [vertices, newton, linear, residual, wall_seconds, intersections, used] = stage;
        counts.insert(counts.end(), {vertices, newton, linear, intersections, int(used)});
        measures.insert(measures.end(), {std::isnan(residual) ? diverged : residual, wall_seconds});
    }
    save("coarse.counts", counts);
    save("coarse.measures", measures);
    save("coarse.positions", coarse.positions);
}

CoarseStart coarse_of(const CheckpointLoader& load, const ClothModel& model)
{
    CoarseStart coarse;
    const std::vector<int>& counts = load.integers("coarse.counts");
    const std::size_t done = counts.size() / coarse_counts;
    if (counts.size() != done * coarse_counts || done > model.coarser.size())
        load.refuse("coarse.counts", fmt::format("{} numbers", counts.size()),
                    fmt::format("{} for each of at most {} coarser cloths", coarse_counts, model.coarser.size()));
    const std::vector<double>& measures = load.reals("coarse.measures", coarse_measures * done);
    for (std::size_t k = 0; k < done; ++k) {
        const int* count = counts.data() + coarse_counts * k;
        const double residual = measures[coarse_measures * k];
        CoarseStage stage{.vertices = count[0],
                          .newton_iterations = count[1],
                          .linear_iterations = count[2],
                          .wall_seconds = measures[coarse_measures * k + 1],
                          .intersections = count[3],
                          .used = count[4] != 0};
        if (residual != diverged) stage.residual = residual;
        coarse.stages.push_back(stage);
    }
    coarse.positions = load.vectors("coarse.positions");
    const std::size_t left = model.coarser.size() - done;  // the shape is one of the next finer cloth
    const Cloth& next = left == 0 ? model.cloth : model.coarser[left - 1];
    if (!coarse.positions.empty() && coarse.positions.size() != next.positions.size())
        load.refuse("coarse.positions", fmt::format("{} positions", coarse.positions.size()),
                    fmt::format("{}", next.positions.size()));
    return coarse;
}

}  // namespace

std::string model_fingerprint(const SceneModel& model)
{
    Fingerprint print;
    const Cloth& cloth = model.cloth_model.cloth;
    for (const Vec3& x : cloth.positions) print.add(x);
    for (const Vec2& u : cloth.panel_coordinates) {
        print.add(u.x());
        print.add(u.y());
    }
    for (const Face& f : cloth.faces) print.add(f);
    for (const auto& pair : cloth.seam_pairs) print.add(pair);
    for (const auto& [name, f] : model.cloth_model.fabrics)
        for (double value :
             {f.areal_density, f.stretch_weft, f.stretch_warp, f.stretch_coupling, f.shear, f.bending_weft,
              f.bending_warp, f.hysteresis_weft, f.hysteresis_warp, f.friction, f.damping})
            print.add(value);
    for (const auto& [name, f] : model.cloth_model.fabrics)
        for (const StressCurve& curve : membrane_curves(f))
            for (const CurveRange& range : curve) print.add(range);
    for (const Body& body : model.cloth_model.bodies) {
        for (const Vec3& x : body.mesh.vertices) print.add(x);
        // Where it is at a few times tells motions apart.
        for (int k = 1; body.motion && k <= 8; ++k)
            for (const Vec3& x : body_mesh_at(body, body.motion->end() * k / 8).vertices) print.add(x);
    }
    for (const PinMotion& motion : cloth.pin_motions) {
        print.add(motion.velocity);
        print.add(motion.axis);
        print.add(motion.point);
        for (double value : {motion.start, motion.end, motion.turns}) print.add(value);
        for (int vertex : motion.vertices) print.add(vertex);
    }
    return print.text();
}

void save_run(const std::string& path, const SceneModel& model, const RunProgress& p, const Phase& phase,
              Integrator& integrator)
{
    Checkpoint checkpoint;
    checkpoint.words = {{"model", model_fingerprint(model)},
                        {"phase", text_of(p.stage)},
                        {"integrators", fmt::format("{}", fmt::join(p.counters.integrators, " "))}};
    const CheckpointSaver save{checkpoint};
    RunProgress progress = p;
    if (phase.state().awake.all) progress.draping.asleep = 0;
    visit_progress(progress, save);
    save_stability(save, p.stability);
    save_coarse(save, p.coarse);
    for (const auto& [name, seconds] : p.counters.phases) save(std::string(seconds_prefix) + name, seconds);
    save_phase(checkpoint, phase, integrator);
    write_checkpoint(path, checkpoint);
}

RunProgress load_progress(const Checkpoint& checkpoint, const std::string& path, const SceneModel& model)
{
    const CheckpointLoader load{checkpoint, path};
    if (load.word("model") != model_fingerprint(model))
        load.refuse("model", "the checkpoint of another cloth, fabric or body",
                    "one left by this scene; run without --resume to start anew");
    RunProgress p;
    const std::string word = load.word("phase");
    const std::optional<RunStage> stage = find_word<RunStage>(word);
    if (!stage) load.refuse("phase", "`" + word + "`", "sew, press, coarse or drape");
    p.stage = *stage;
    visit_progress(p, load);
    p.stability = stability_of(load);
    p.coarse = coarse_of(load, model.cloth_model);
    if (p.frames < 0) load.refuse("frames", fmt::format("{}", p.frames), "a count");
    std::istringstream integrators(load.word("integrators"));
    for (std::string name; integrators >> name;) p.counters.integrators.push_back(name);
    for (const auto& [name, values] : checkpoint.reals)
        if (name.starts_with(seconds_prefix))
            p.counters.phases[name.substr(seconds_prefix.size())] = load.reals(name, 1)[0];
    return p;
}

}  // namespace selvage
