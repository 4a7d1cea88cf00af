#include "host/run/phase_memory.hpp"

#include <limits>
#include <stdexcept>

#include <fmt/format.h>

#include "host/run/checkpoint_values.hpp"
#include "host/solver/state/snapshot.hpp"
#include "host/solver/stepping/sleep.hpp"

namespace selvage {
namespace {

constexpr int keys_per_candidate = 5;  // its kind and its corners

void save_candidates(const CheckpointSaver& save, const std::string& name, const std::vector<PairCandidate>& candidates)
{
    std::vector<int> keys;
    std::vector<float> distance;
    for (const PairCandidate& candidate : candidates) {
        keys.push_back(candidate.edges);
        keys.insert(keys.end(), candidate.corner.begin(), candidate.corner.end());
        distance.push_back(candidate.distance);
    }
    save(name + ".keys", keys);
    save(name + ".distance", distance);
}

std::vector<PairCandidate> candidates_of(const CheckpointLoader& load, const std::string& name)
{
    const std::vector<int>& keys = load.integers(name + ".keys");
    const std::vector<double>& distance = load.reals(name + ".distance");
    if (keys.size() != keys_per_candidate * distance.size())
        load.refuse(name + ".keys", fmt::format("{} numbers", keys.size()),
                    fmt::format("{}", keys_per_candidate * distance.size()));
    std::vector<PairCandidate> candidates(distance.size());
    for (std::size_t k = 0; k < candidates.size(); ++k) {
        const int* key = keys.data() + keys_per_candidate * k;
        candidates[k].edges = key[0] != 0;
        std::copy_n(key + 1, 4, candidates[k].corner.begin());
        candidates[k].distance = float(distance[k]);
    }
    return candidates;
}

void save_searches(const CheckpointSaver& save, const CcdMemory& memory)
{
    save_candidates(save, "searches.asleep", memory.tree.asleep);
    save("searches.valid", int(memory.tree.valid));
    if (!memory.tree.valid) return;
    save("searches.start", memory.tree.start);
    save("searches.end", memory.tree.end);
    save("searches.slack", memory.tree.slack);
    save("searches.skipped", memory.tree.skipped);
    save("searches.partial", memory.tree.partial);
    save_candidates(save, "searches.found", memory.tree.candidates);
    std::vector<float> distance, approach;
    std::vector<char> relevant;
    for (const PairDistance& at : memory.distances) {
        distance.push_back(at.distance);
        approach.push_back(at.approach);
        relevant.push_back(at.relevant);
    }
    save("searches.distance", distance);
    save("searches.approach", approach);
    save("searches.relevant", relevant);
    save("searches.position", memory.position);
}

CcdMemory searches_of(const CheckpointLoader& load)
{
    CcdMemory memory;
    memory.tree.asleep = candidates_of(load, "searches.asleep");
    memory.tree.valid = load.integer("searches.valid", 0, 1) == 1;
    if (!memory.tree.valid) return memory;
    memory.tree.start = load.vectors("searches.start");
    memory.tree.end = load.vectors("searches.end");
    const std::vector<double>& slack = load.reals("searches.slack");
    memory.tree.slack.assign(slack.begin(), slack.end());
    memory.tree.skipped = load.integers("searches.skipped");
    memory.tree.partial = load.integer("searches.partial", 0, std::numeric_limits<int>::max() - 1);
    memory.tree.candidates = candidates_of(load, "searches.found");
    const std::size_t count = memory.tree.candidates.size();
    const std::vector<double>&distance = load.reals("searches.distance", count),
          &approach = load.reals("searches.approach", count);
    const std::vector<char> relevant = load.flags("searches.relevant", count);
    for (std::size_t k = 0; k < count; ++k)
        memory.distances.push_back(
            {float(distance[k]), float(approach[k]), float(distance[k] - approach[k]), relevant[k] != 0});
    memory.position = load.vectors("searches.position");
    return memory;
}

void save_cloth_contact(const CheckpointSaver& save, const ClothContact& contact)
{
    const PackedFriction friction = pack(contact.memory());
    save("pair_keys", friction.keys);
    save("pair_memory", friction.values);
    save("cloth_inside", contact.crossings().inside);
    save("cloth_tangled", contact.crossings().tangled);
    save("cloth_pierced", contact.crossings().pierced);
    save_searches(save, contact.searches());
}

// Pairs that friction remembers are listed wherever they are, so they must be of this cloth.
void check_corners(const CheckpointLoader& load, const FrictionMemory& memory, const State& state)
{
    for (const PairFriction& friction : memory)
        for (int v : friction.pair.corner)
            if (v >= state.size.vertex_count || v < -state.size.body_point_count)
                load.refuse("pair_keys", fmt::format("{}", v), "a vertex of the cloth, or a corner of a body below 0");
}

FrictionMemory friction_of(const CheckpointLoader& load, const State& state)
{
    const std::vector<int>& keys = load.integers("pair_keys");
    const std::vector<double>& values = load.reals("pair_memory");
    std::optional<FrictionMemory> memory = unpack({keys, values});
    if (!memory)
        load.refuse("pair_memory", fmt::format("{} keys and {} values", keys.size(), values.size()),
                    fmt::format("{} keys and {} values for each pair in contact, pairs in ascending order",
                                PackedFriction::keys_per_pair, PackedFriction::values_per_pair));
    check_corners(load, *memory, state);
    return std::move(*memory);
}

// The pairs' fields without the room between their planes, which depends on how many pairs there have been.
template <class T>
std::vector<T> packed_planes(const std::vector<T>& field, int components, int stride, int count)
{
    std::vector<T> packed;
    for (int c = 0; c < components; ++c) {
        const auto plane = field.begin() + std::ptrdiff_t(c) * stride;
        packed.insert(packed.end(), plane, plane + count);
    }
    return packed;
}

bool of_pairs(const FieldInfo& info) { return info.per == "pair"; }

void save_found(const CheckpointSaver& save, const State& state)
{
    save("pair_count", state.size.pair_count);
    visit_found(state, [&](std::string_view name, const auto& field, const FieldInfo& info) {
        if (of_pairs(info) && !field.empty())
            save(name, packed_planes(field, info.components, state.size.pair_stride, state.size.pair_count));
        else
            save(name, field);
    });
}

void check_pairs(const CheckpointLoader& load, const State& state)
{
    for (int p = 0; p < state.size.pair_count; ++p)
        for (int i = 0; i < 4; ++i) {
            const int v = state.pair_vertex[i * state.size.pair_stride + p];
            if (v >= state.size.vertex_count || v < -state.size.body_point_count)
                load.refuse("pair_vertex", fmt::format("{}", v),
                            "a vertex of the cloth, or a corner of a body below 0");
        }
}

template <class T>
const std::vector<T>& loaded(const CheckpointLoader& load, std::string_view name, std::size_t size);
template <>
const std::vector<real>& loaded(const CheckpointLoader& load, std::string_view name, std::size_t size)
{
    return load.reals(name, size);
}
template <>
const std::vector<int>& loaded(const CheckpointLoader& load, std::string_view name, std::size_t size)
{
    return load.integers(name, size);
}

void load_found(const CheckpointLoader& load, State& state)
{
    // Each pair has a word in pair_edges, so that more than the file holds is not asked for.
    const int count = load.integer("pair_count", 0, int(load.integers("pair_edges").size()));
    state.set_pairs(count);
    visit_found(state, [&]<class T>(std::string_view name, std::vector<T>& field, const FieldInfo& info) {
        if (!of_pairs(info) || field.empty()) {
            field = loaded<T>(load, name, field.size());
            return;
        }
        const std::vector<T>& packed = loaded<T>(load, name, std::size_t(info.components) * std::size_t(count));
        for (int c = 0; c < info.components; ++c)
            std::copy_n(packed.begin() + std::ptrdiff_t(c) * count, count,
                        field.begin() + std::ptrdiff_t(c) * state.size.pair_stride);
    });
    if (state.pair_vertex.empty()) return;
    check_pairs(load, state);
    list_pair_slots(state);
}

// What changes of a system beside its fields: parameters that sewing raises, and the air as it was last asked for.
template <class AnySystem, class Visit>
void visit_params(AnySystem& system, const Visit& visit)
{
    visit("seam.stiffness", system.params().seam.stiffness);
    visit("seam.force_limit", system.params().seam.force_limit);
    const auto visit_air = [&](const std::string& term, auto& air) {
        visit(term + ".velocity_x", air.velocity_x);
        visit(term + ".velocity_y", air.velocity_y);
        visit(term + ".velocity_z", air.velocity_z);
    };
    visit_air("wind", system.params().wind);
    visit_air("air_drag", system.params().air_drag);
}

template <class Visit>
void visit_history(Integrator& integrator, const Visit& visit)
{
    for (const HistoryArray& array : integrator.history())
        visit("integrator." + std::string(array.name), *array.values);
}

void place_boundary(const CheckpointLoader& load, System& system)
{
    double time = 0, boundary_time = 0;
    load("time", time);
    load("boundary_time", boundary_time);
    for (const auto& [name, value] : {std::pair("time", time), std::pair("boundary_time", boundary_time)})
        if (value < 0) load.refuse(name, fmt::format("{}", value), "a time of at least 0");
    system.clock() = {boundary_time, 0};
    system.place_boundary();
    system.clock().time = time;
}

void load_cloth_contact(const CheckpointLoader& load, System& system)
{
    ClothContact& contact = *system.cloth_contact();
    const std::size_t particles = std::size_t(system.state().size.vertex_count);
    CrossingFlags crossings;
    crossings.inside = load.flags("cloth_inside", particles);
    crossings.tangled = load.flags("cloth_tangled", particles);
    crossings.pierced = load.flags("cloth_pierced", particles);
    contact.set_crossings(std::move(crossings));
    contact.set_memory(friction_of(load, system.state()));
}

void load_searches(const CheckpointLoader& load, System& system)
{
    try {
        system.cloth_contact()->set_searches(searches_of(load));
    } catch (const std::invalid_argument& error) {
        load.refuse("searches", error.what(), "that of this cloth");
    }
}

}  // namespace

void save_phase(Checkpoint& checkpoint, const Phase& phase, Integrator& integrator)
{
    const CheckpointSaver save{checkpoint};
    const System& system = phase.system();
    const State& state = system.state();
    const ClothBodyContact* bodies = system.body_contact();
    checkpoint.words["integrator"] = integrator.info().name;
    save("time", system.clock().time);
    save("boundary_time", bodies ? bodies->time() : 0.0);
    save("body_contacts", bodies ? bodies->contact_count() : 0);
    visit_params(system, save);
    visit_kept(state, save);
    visit_history(integrator, save);
    save_found(save, state);
    if (system.cloth_contact()) save_cloth_contact(save, *system.cloth_contact());
    save("sleeps", int(!state.awake.all));
    if (state.awake.all) return;
    save("is_awake", state.awake.is_awake);
    save("asleep", state.awake.force_squared);
}

void load_phase(const Checkpoint& checkpoint, const std::string& path, Phase& phase, Integrator& integrator)
{
    const CheckpointLoader load{checkpoint, path};
    System& system = phase.system();
    State& state = system.state();
    visit_params(system, load);
    visit_kept(state, load);
    // Where solver.until has changed from a time to equilibrium or back, another scheme may go on.
    if (load.word("integrator") == integrator.info().name) visit_history(integrator, load);
    if (system.cloth_contact()) load_cloth_contact(load, system);
    place_boundary(load, system);
    const bool sleeps = load.integer("sleeps", 0, 1) == 1;
    // Memories of searches are put over those of a search here.
    if (system.cloth_contact()) system.refresh_pairs();
    load_found(load, state);
    if (system.body_contact())
        system.body_contact()->set_contact_count(load.integer("body_contacts", 0, state.size.vertex_count));
    if (sleeps) {
        system.evaluate_forces(false);  // the turns of hinges asleep
        put_to_sleep(system, load.flags("is_awake", std::size_t(state.size.vertex_count)), load.reals("asleep", 1)[0]);
    }
    if (system.cloth_contact()) load_searches(load, system);
}

}  // namespace selvage
