#include "host/run/restart.hpp"

#include <cstring>

#include <fmt/format.h>

#include "host/model/body.hpp"
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
        throw InputError({path, 0, 0, name}, fmt::format("{} numbers", found), fmt::format("{} numbers", size));
    return at->second;
}

std::string history_name(std::size_t index) { return fmt::format("history_{}", index); }

std::string word_of(const Checkpoint& checkpoint, const std::string& name)
{
    const auto at = checkpoint.words.find(name);
    return at == checkpoint.words.end() ? std::string() : at->second;
}

}  // namespace

std::string model_fingerprint(const SceneModel& model)
{
    Fingerprint print;
    const Cloth& cloth = model.model.cloth;
    for (const Vec3& x : cloth.positions) print.add(x);
    for (const Vec2& u : cloth.panel_coordinates) {
        print.add(u.x());
        print.add(u.y());
    }
    for (const Face& f : cloth.faces) print.add(f);
    for (const auto& pair : cloth.seam_pairs) print.add(pair);
    for (const auto& [name, f] : model.model.fabrics)
        for (double value :
             {f.areal_density, f.stretch_weft, f.stretch_warp, f.stretch_coupling, f.shear, f.bending_weft,
              f.bending_warp, f.hysteresis_weft, f.hysteresis_warp, f.friction, f.damping})
            print.add(value);
    for (const auto& [name, f] : model.model.fabrics)
        for (const StressCurve& curve : membrane_curves(f))
            for (const CurveRange& range : curve) print.add(range);
    for (const Body& body : model.model.bodies) {
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
    checkpoint.words = {
        {"model", model_fingerprint(model)}, {"phase", p.phase}, {"integrator", std::string(integrator.info().name)}};
    checkpoint.integers["counts"] = {p.counters.steps,
                                     p.counters.newton_iterations,
                                     p.counters.linear_iterations,
                                     p.frames,
                                     p.sewing.steps_without_gain,
                                     p.pressing.step,
                                     p.draping.hold,
                                     p.draping.load,
                                     state.awake.all ? 0 : p.draping.asleep};
    checkpoint.reals["clock"] = {p.counters.simulated, p.wall_seconds};
    checkpoint.reals["sewing"] = {
        p.sewing.time,          p.sewing.best_gap, p.sewing.elastic_energy,       p.sewing.gap,
        p.sewing.energy_change, p.sewing.dt,       phase.params().seam.stiffness, phase.params().seam.force_limit};
    checkpoint.reals["draping"] = {p.pressing.dt, p.draping.time, p.draping.switch_residual, p.draping.residual,
                                   p.draping.dt};
    checkpoint.reals["pos"] = state.pos;
    checkpoint.reals["vel"] = state.vel;
    checkpoint.reals["friction_anchor"] = state.friction_anchor;
    checkpoint.reals["friction_limit"] = state.friction_limit;
    checkpoint.reals["hinge_anchor"] = state.hinge_anchor;
    if (!state.awake.all) {
        checkpoint.integers["is_awake"].assign(state.awake.is_awake.begin(), state.awake.is_awake.end());
        checkpoint.reals["asleep"] = {state.awake.force_squared};
    }
    if (phase.cloth_contact()) {
        checkpoint.reals["pair_memory"] = phase.cloth_contact()->memory();
        checkpoint.reals["cloth_faults"] = phase.cloth_contact()->faults();
    }
    for (const auto& [name, seconds] : p.counters.phases) checkpoint.reals["phase_" + name] = {seconds};
    const auto history = integrator.history();
    for (std::size_t k = 0; k < history.size(); ++k) checkpoint.reals[history_name(k)] = *history[k];
    write_checkpoint(path, checkpoint);
}

RunProgress load_progress(const Checkpoint& checkpoint, const std::string& path, const SceneModel& model)
{
    if (word_of(checkpoint, "model") != model_fingerprint(model))
        throw InputError({path, 0, 0, "model"}, "the checkpoint of another cloth, fabric or body",
                         "one left by this scene; run without --resume to start anew");
    RunProgress p;
    p.phase = word_of(checkpoint, "phase");
    if (p.phase != "sew" && p.phase != "press" && p.phase != "coarse" && p.phase != "drape")
        throw InputError({path, 0, 0, "phase"}, "`" + p.phase + "`", "sew, press, coarse or drape");
    const auto& counts = array_of(checkpoint.integers, "counts", path, 9);
    const auto& clock = array_of(checkpoint.reals, "clock", path, 2);
    const auto& sewing = array_of(checkpoint.reals, "sewing", path, 8);
    const auto& draping = array_of(checkpoint.reals, "draping", path, 5);
    p.counters.steps = counts[0];
    p.counters.newton_iterations = counts[1];
    p.counters.linear_iterations = counts[2];
    p.frames = counts[3];
    p.counters.simulated = clock[0];
    p.wall_seconds = clock[1];
    p.sewing = {sewing[0], sewing[1], counts[4], sewing[2], sewing[3], sewing[4], sewing[5]};
    p.pressing = {counts[5], draping[0]};
    p.draping = {draping[1], draping[2], counts[6], draping[3], draping[4], counts[7], counts[8]};
    for (const auto& [name, values] : checkpoint.reals)
        if (name.starts_with("phase_") && !values.empty()) p.counters.phases[name.substr(6)] = values.front();
    return p;
}

void load_particles(const Checkpoint& checkpoint, const std::string& path, Phase& phase)
{
    State& state = phase.state();
    const auto take = [&](const char* name, std::vector<real>& to) {
        to = array_of(checkpoint.reals, name, path, to.size());
    };
    take("pos", state.pos);
    take("vel", state.vel);
    take("friction_anchor", state.friction_anchor);
    take("friction_limit", state.friction_limit);
    take("hinge_anchor", state.hinge_anchor);
    if (ClothContact* cloth = phase.cloth_contact()) {
        const auto found = checkpoint.reals.find("pair_memory");
        if (found == checkpoint.reals.end() || found->second.size() % ClothContact::memory_size != 0)
            throw InputError({path, 0, 0, "pair_memory"}, "no such array, or a part of one",
                             "whole records of contacts");
        cloth->memory() = found->second;
    }
    const auto& sewing = array_of(checkpoint.reals, "sewing", path, 8);
    phase.params().seam.stiffness = sewing[6];
    phase.params().seam.force_limit = sewing[7];
    phase.look_around();
    if (ClothContact* cloth = phase.cloth_contact())
        cloth->set_faults(array_of(checkpoint.reals, "cloth_faults", path, cloth->faults().size()));
    if (!checkpoint.integers.contains("is_awake")) return;
    const auto& awake = array_of(checkpoint.integers, "is_awake", path, std::size_t(state.size.vertex_count));
    phase.newton().static_residual();  // what sleeps is evaluated for the last time
    put_to_sleep(phase, std::vector<char>(awake.begin(), awake.end()),
                 array_of(checkpoint.reals, "asleep", path, 1)[0]);
}

void load_history(const Checkpoint& checkpoint, const std::string& path, Integrator& integrator)
{
    if (word_of(checkpoint, "integrator") != integrator.info().name) return;
    const auto history = integrator.history();
    for (std::size_t k = 0; k < history.size(); ++k)
        *history[k] = array_of(checkpoint.reals, history_name(k).c_str(), path, history[k]->size());
}

}  // namespace selvage
