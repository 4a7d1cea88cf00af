#include "host/run/restart.hpp"

#include <cstring>
#include <sstream>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "host/model/body.hpp"
#include "host/solver/state/snapshot.hpp"
#include "host/solver/stepping/sleep.hpp"
#include "io/errors.hpp"

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

template <class T>
const std::vector<T>& array_of(const std::map<std::string, std::vector<T>>& arrays, const char* name,
                               const std::string& path, std::size_t size)
{
    const auto at = arrays.find(name);
    const std::size_t found = at == arrays.end() ? 0 : at->second.size();
    if (at == arrays.end() || found != size)
        throw InputError({path, 0, 0, name}, fmt::format("{} numbers", found),
                         fmt::format("{} numbers, in a checkpoint of this version of selvage", size));
    return at->second;
}

void save_contact(Checkpoint& checkpoint, const ClothContact& contact)
{
    PackedFriction friction = pack(contact.memory());
    checkpoint.integers["pair_keys"] = std::move(friction.keys);
    checkpoint.reals["pair_friction"] = std::move(friction.values);
    const auto save_flags = [&](const char* name, const std::vector<char>& flags) {
        checkpoint.integers[name].assign(flags.begin(), flags.end());
    };
    save_flags("cloth_inside", contact.crossings().inside);
    save_flags("cloth_tangled", contact.crossings().tangled);
    save_flags("cloth_pierced", contact.crossings().pierced);
}

FrictionMemory friction_memory_of(const Checkpoint& checkpoint, const std::string& path)
{
    const auto keys = checkpoint.integers.find("pair_keys");
    const auto values = checkpoint.reals.find("pair_friction");
    if (keys == checkpoint.integers.end() || values == checkpoint.reals.end())
        throw InputError({path, 0, 0, "pair_friction"}, "no such array", "pair_keys and pair_friction");
    std::optional<FrictionMemory> memory = unpack({keys->second, values->second});
    if (!memory)
        throw InputError({path, 0, 0, "pair_friction"},
                         fmt::format("{} keys and {} values", keys->second.size(), values->second.size()),
                         fmt::format("{} keys and {} values for each pair in contact, pairs in ascending order",
                                     PackedFriction::keys_per_pair, PackedFriction::values_per_pair));
    return std::move(*memory);
}

CrossingFlags crossings_of(const Checkpoint& checkpoint, const std::string& path, std::size_t particles)
{
    const auto flags = [&](const char* name) {
        const std::vector<int>& values = array_of(checkpoint.integers, name, path, particles);
        for (int value : values)
            if (value != 0 && value != 1) throw InputError({path, 0, 0, name}, fmt::format("{}", value), "0 or 1");
        return std::vector<char>(values.begin(), values.end());
    };
    CrossingFlags crossings;
    crossings.inside = flags("cloth_inside");
    crossings.tangled = flags("cloth_tangled");
    crossings.pierced = flags("cloth_pierced");
    return crossings;
}

std::string word_in(const Checkpoint& checkpoint, const std::string& name)
{
    const auto at = checkpoint.words.find(name);
    return at == checkpoint.words.end() ? std::string() : at->second;
}

// Names every number of what a run remembers beside the particles. The bindings name all members of a struct, so a new
// one does not compile until it is given a name here.
template <class Progress, class Visit>
void visit_sewing(Progress& sewing, const Visit& visit)
{
    auto& [best_gap, steps_without_gain, elastic_energy, gap, energy_change, dt] = sewing;
    visit("sewing.best_gap", best_gap);
    visit("sewing.steps_without_gain", steps_without_gain);
    visit("sewing.elastic_energy", elastic_energy);
    visit("sewing.gap", gap);
    visit("sewing.energy_change", energy_change);
    visit("sewing.dt", dt);
}

template <class Progress, class Visit>
void visit_draping(Progress& draping, const Visit& visit)
{
    auto& [switch_residual, hold, residual, dt, load, asleep] = draping;
    visit("draping.switch_residual", switch_residual);
    visit("draping.hold", hold);
    visit("draping.residual", residual);
    visit("draping.dt", dt);
    visit("draping.load", load);
    visit("draping.asleep", asleep);
}

template <class Progress, class Visit>
void visit_progress(Progress& progress, const Visit& visit)
{
    auto& [stage, sewing, pressing, draping, counters, wall_seconds, frames] = progress;  // the stage is a word
    visit_sewing(sewing, visit);
    auto& [press_step, press_dt] = pressing;
    visit("pressing.step", press_step);
    visit("pressing.dt", press_dt);
    visit_draping(draping, visit);
    // Seconds have names of their own, integrators are words.
    auto& [steps, newton_iterations, linear_iterations, simulated, seconds, integrators, largest] = counters;
    visit("counters.steps", steps);
    visit("counters.newton_iterations", newton_iterations);
    visit("counters.linear_iterations", linear_iterations);
    visit("counters.simulated", simulated);
    auto& [stretch, face, stretch_time] = largest;
    visit("largest.stretch", stretch);
    visit("largest.face", face);
    visit("largest.time", stretch_time);
    visit("wall_seconds", wall_seconds);
    visit("frames", frames);
}

// What changes of a system beside its fields: the time, and parameters that sewing raises.
template <class AnySystem, class Visit>
void visit_system(AnySystem& system, const Visit& visit)
{
    visit("time", system.clock().time);
    visit("seam.stiffness", system.params().seam.stiffness);
    visit("seam.force_limit", system.params().seam.force_limit);
}

// Takes and gives values by name.
struct Saver {
    Checkpoint& to;

    void operator()(std::string_view name, int value) const { to.integers[std::string(name)] = {value}; }
    void operator()(std::string_view name, double value) const { to.reals[std::string(name)] = {value}; }
    void operator()(std::string_view name, const std::vector<real>& values) const
    {
        to.reals[std::string(name)] = values;
    }
};

struct Loader {
    const Checkpoint& from;
    const std::string& path;

    void operator()(std::string_view name, int& value) const
    {
        value = array_of(from.integers, std::string(name).c_str(), path, 1)[0];
    }
    void operator()(std::string_view name, double& value) const
    {
        value = array_of(from.reals, std::string(name).c_str(), path, 1)[0];
    }
    void operator()(std::string_view name, std::vector<real>& values) const
    {
        values = array_of(from.reals, std::string(name).c_str(), path, values.size());
    }
};

template <class Visit>
void visit_history(Integrator& integrator, const Visit& visit)
{
    for (const HistoryArray& array : integrator.history())
        visit("integrator." + std::string(array.name), *array.values);
}

constexpr std::string_view seconds_prefix = "seconds.";  // of each phase

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
    const State& state = phase.state();
    Checkpoint checkpoint;
    checkpoint.words = {{"model", model_fingerprint(model)},
                        {"phase", text_of(p.stage)},
                        {"integrator", std::string(integrator.info().name)},
                        {"integrators", fmt::format("{}", fmt::join(p.counters.integrators, " "))}};
    const Saver save{checkpoint};
    RunProgress progress = p;
    if (state.awake.all) progress.draping.asleep = 0;
    visit_progress(progress, save);
    visit_system(phase.system(), save);
    visit_kept(state, save);
    visit_history(integrator, save);
    if (!state.awake.all) {
        checkpoint.integers["is_awake"].assign(state.awake.is_awake.begin(), state.awake.is_awake.end());
        checkpoint.reals["asleep"] = {state.awake.force_squared};
    }
    if (phase.cloth_contact()) save_contact(checkpoint, *phase.cloth_contact());
    for (const auto& [name, seconds] : p.counters.phases) save(std::string(seconds_prefix) + name, seconds);
    write_checkpoint(path, checkpoint);
}

RunProgress load_progress(const Checkpoint& checkpoint, const std::string& path, const SceneModel& model)
{
    if (word_in(checkpoint, "model") != model_fingerprint(model))
        throw InputError({path, 0, 0, "model"}, "the checkpoint of another cloth, fabric or body",
                         "one left by this scene; run without --resume to start anew");
    RunProgress p;
    const std::string word = word_in(checkpoint, "phase");
    const std::optional<RunStage> stage = find_word<RunStage>(word);
    if (!stage) throw InputError({path, 0, 0, "phase"}, "`" + word + "`", "sew, press, coarse or drape");
    p.stage = *stage;
    visit_progress(p, Loader{checkpoint, path});
    std::istringstream integrators(word_in(checkpoint, "integrators"));
    for (std::string name; integrators >> name;) p.counters.integrators.push_back(name);
    for (const auto& [name, values] : checkpoint.reals)
        if (name.starts_with(seconds_prefix) && !values.empty())
            p.counters.phases[name.substr(seconds_prefix.size())] = values.front();
    return p;
}

void load_particles(const Checkpoint& checkpoint, const std::string& path, Phase& phase)
{
    State& state = phase.state();
    const Loader load{checkpoint, path};
    visit_kept(state, load);
    visit_system(phase.system(), load);
    if (phase.cloth_contact()) phase.cloth_contact()->set_memory(friction_memory_of(checkpoint, path));
    phase.system().find_contacts();
    if (phase.cloth_contact())
        phase.cloth_contact()->set_crossings(crossings_of(checkpoint, path, std::size_t(state.size.vertex_count)));
    if (!checkpoint.integers.contains("is_awake")) return;
    const auto& awake = array_of(checkpoint.integers, "is_awake", path, std::size_t(state.size.vertex_count));
    phase.system().refresh_pairs();
    phase.system().evaluate_forces(false);
    put_to_sleep(phase.system(), std::vector<char>(awake.begin(), awake.end()),
                 array_of(checkpoint.reals, "asleep", path, 1)[0]);
}

void load_history(const Checkpoint& checkpoint, const std::string& path, Integrator& integrator)
{
    if (word_in(checkpoint, "integrator") != integrator.info().name) return;
    visit_history(integrator, Loader{checkpoint, path});
}

}  // namespace selvage
