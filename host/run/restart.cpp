#include "host/run/restart.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "host/run/checkpoint_values.hpp"
#include "host/run/phase_memory.hpp"
#include "host/scene/scene_values.hpp"
#include "io/content_hash.hpp"

namespace selvage {
namespace {

// Adds the bits of numbers, or of vectors of them.
template <class T>
void add(ContentHash& hash, const std::vector<T>& items)
{
    hash.add({reinterpret_cast<const char*>(items.data()), items.size() * sizeof(T)});
}

// Cloth, seams and bodies; the scene says everything else.
std::string hash_of_meshes(const ClothModel& model)
{
    ContentHash hash;
    add(hash, model.cloth.positions);
    add(hash, model.cloth.panel_coordinates);
    add(hash, model.cloth.faces);
    add(hash, model.cloth.seam_pairs);
    for (const Body& body : model.bodies) add(hash, body.mesh.vertices);
    return hash.text();
}

// One line for each key; words of a scene hold no line breaks but in long texts, which are of no account here.
std::string lines_of(const std::map<std::string, std::string>& values)
{
    std::string lines;
    for (const auto& [key, value] : values) lines += key + "=" + std::string(value, 0, value.find('\n')) + "\n";
    return lines;
}

std::map<std::string, std::string> values_of(const std::string& lines)
{
    std::map<std::string, std::string> values;
    std::istringstream stream(lines);
    for (std::string line; std::getline(stream, line);) {
        const std::size_t middle = std::min(line.find('='), line.size());
        values[line.substr(0, middle)] = line.substr(std::min(middle + 1, line.size()));
    }
    return values;
}

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
    // Which pairs are welded is not always there.
    auto& [welded, steps_since_look, harder, looks_in_vain, open_way, on_thin, grows_from, failures, settled_steps,
           elastic_energy, energy_change, steps] = sewing;
    visit("sewing.steps_since_look", steps_since_look);
    visit("sewing.harder", harder);
    visit("sewing.looks_in_vain", looks_in_vain);
    visit("sewing.open_way", open_way);
    visit("sewing.on_thin", on_thin);
    visit("sewing.grows_from", grows_from);
    visit("sewing.failures", failures);
    visit("sewing.settled_steps", settled_steps);
    visit("sewing.elastic_energy", elastic_energy);
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

template <class Accuracy, class Visit>
void visit_accuracy(Accuracy& accuracy, const Visit& visit)
{
    auto& [steps, unsolved, largest_left, left_time, sum_left, estimates, largest_error, error_time, sum_error] =
        accuracy;
    visit("accuracy.steps", steps);
    visit("accuracy.unsolved", unsolved);
    visit("accuracy.largest_left", largest_left);
    visit("accuracy.left_time", left_time);
    visit("accuracy.sum_left", sum_left);
    visit("accuracy.estimates", estimates);
    visit("accuracy.largest_error", largest_error);
    visit("accuracy.error_time", error_time);
    visit("accuracy.sum_error", sum_error);
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
    auto& [steps, newton_iterations, linear_iterations, simulated, seconds, integrators, accuracy, largest] = counters;
    visit("counters.steps", steps);
    visit("counters.newton_iterations", newton_iterations);
    visit("counters.linear_iterations", linear_iterations);
    visit("counters.simulated", simulated);
    visit_accuracy(accuracy, visit);
    auto& [iterations_since_frame, relaxed_since_frame] = frame;
    visit("frame.iterations", iterations_since_frame);
    visit("frame.relaxed", relaxed_since_frame);
    visit("ended", ended);
    auto& [stretch, face, stretch_time] = largest;
    visit("largest.stretch", stretch);
    visit("largest.face", face);
    visit("largest.time", stretch_time);
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

// @param goes_on  there are coarser cloths to drape yet
CoarseStart coarse_of(const CheckpointLoader& load, const std::vector<std::size_t>& carried_to, bool goes_on)
{
    CoarseStart coarse;
    const std::vector<int>& counts = load.integers("coarse.counts");
    const std::size_t done = counts.size() / coarse_counts;
    if (counts.size() != done * coarse_counts || (goes_on && done > carried_to.size()))
        load.refuse("coarse.counts", fmt::format("{} numbers", counts.size()),
                    fmt::format("{} for each of at most {} coarser cloths", coarse_counts, carried_to.size()));
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
    const std::size_t expected = goes_on && done > 0 ? carried_to[done - 1] : 0;
    if (!coarse.positions.empty() && coarse.positions.size() != expected)
        load.refuse("coarse.positions", fmt::format("{} positions", coarse.positions.size()),
                    fmt::format("{}", expected));
    return coarse;
}

}  // namespace

RunIdentity identity_of(const RunSettings& settings, const SceneModel& model)
{
    const ClothModel& cloths = model.cloth_model;
    RunIdentity identity{
        settings.values, hash_of_meshes(cloths), {}, int(cloths.cloth.faces.size()), cloths.cloth.seam_pairs.size()};
    for (std::size_t level = settings.coarser.size(); level-- > 0;)
        identity.carried_to.push_back((level == 0 ? cloths.cloth : cloths.coarser[level - 1]).positions.size());
    return identity;
}

void save_run(const std::string& path, const RunIdentity& identity, const RunProgress& p, const Phase& phase,
              Integrator& integrator)
{
    Checkpoint checkpoint;
    checkpoint.words = {{"scene", lines_of(identity.scene)},
                        {"meshes", identity.meshes},
                        {"phase", text_of(p.stage)},
                        {"integrators", fmt::format("{}", fmt::join(p.counters.integrators, " "))}};
    const CheckpointSaver save{checkpoint};
    RunProgress progress = p;
    if (phase.state().awake.all) progress.draping.asleep = 0;
    visit_progress(progress, save);
    save_stability(save, p.stability);
    save_coarse(save, p.coarse);
    save("sewing.welded", p.sewing.welded);
    for (const auto& [name, seconds] : p.counters.phases) save(std::string(seconds_prefix) + name, seconds);
    save_phase(checkpoint, phase, integrator);
    write_checkpoint(path, checkpoint);
}

RunProgress load_progress(const Checkpoint& checkpoint, const std::string& path, const RunIdentity& identity)
{
    const CheckpointLoader load{checkpoint, path};
    auto now = values_of(lines_of(identity.scene)), before = values_of(load.word("scene"));
    const std::string differing = differing_values(now, before);
    if (!differing.empty())
        load.refuse("scene", "the checkpoint of another scene (" + differing + ")",
                    "one left by this scene; run without --resume to start anew");
    if (load.word("meshes") != identity.meshes)
        load.refuse("meshes", "the checkpoint of other meshes of this scene", "one left by this version of selvage");
    RunProgress p;
    const std::string word = load.word("phase");
    const std::optional<RunStage> stage = find_word<RunStage>(word);
    if (!stage) load.refuse("phase", "`" + word + "`", "sew, press, coarse or drape");
    p.stage = *stage;
    visit_progress(p, load);
    p.ended = p.ended && now["solver.until"] == before["solver.until"];
    p.stability = stability_of(load);
    if (!load.integers("sewing.welded").empty()) p.sewing.welded = load.flags("sewing.welded", identity.seam_pairs);
    p.coarse = coarse_of(load, identity.carried_to, p.stage == RunStage::coarse);
    if (p.frames < 0) load.refuse("frames", fmt::format("{}", p.frames), "a count");
    p.counters.largest.face = load.integer("largest.face", -1, identity.faces - 1);
    std::istringstream integrators(load.word("integrators"));
    for (std::string name; integrators >> name;) p.counters.integrators.push_back(name);
    for (const auto& [name, values] : checkpoint.reals)
        if (name.starts_with(seconds_prefix))
            p.counters.phases[name.substr(seconds_prefix.size())] = load.reals(name, 1)[0];
    return p;
}

}  // namespace selvage
