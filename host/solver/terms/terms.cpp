#include "host/solver/terms/terms.hpp"

#include <type_traits>

#include "host/parallel/launch.hpp"
#include "host/solver/state/pair_list.hpp"
#include "host/solver/state/vectors.hpp"
#include "host/solver/terms/bound_args.hpp"
#include "kernels/stages/gather.h"

namespace selvage {
namespace {

constexpr std::nullptr_t no_stage = nullptr;

// One traits struct per line of kernels/terms.h. The macros below only list and bind; the logic is in templates.
#define LIST_FIELD(name) Field::name,
#define OR_NON_ZERO(name, initial, unit, meaning) || values.name != 0
#define IGNORE(name, initial, unit, meaning)
#define TERM(term, kind, nature_of_term, stage_before, family_of_term)                                    \
    struct term##_traits {                                                                                \
        static constexpr std::string_view name = #term;                                                   \
        static constexpr ItemKind per = ItemKind::kind;                                                   \
        static constexpr Nature nature = Nature::nature_of_term;                                          \
        static constexpr EnergyFamily family = EnergyFamily::family_of_term;                              \
        static FieldSet fields() { return field_set({term##_FIELDS(LIST_FIELD, LIST_FIELD)}); }           \
        static constexpr auto stage = stage_before;                                                       \
        static constexpr auto force = term##_force;                                                       \
        static constexpr auto stiffness = term##_stiffness;                                               \
        static constexpr auto energy = term##_energy;                                                     \
        static int count(const mesh_sizes& size) { return size.kind##_count; }                            \
        static const auto& values(const Params& params) { return params.term; }                           \
        static bool any_strength(const auto& values) { return false term##_PARAMS(OR_NON_ZERO, IGNORE); } \
        using Args = term##_args;                                                                         \
    };
TERMS(TERM)
#undef TERM

template <class Traits>
void run_stage(State& state, const Params& params, const Items& items)
{
    if constexpr (!std::is_null_pointer_v<decltype(Traits::stage)>)
        launch<Traits::stage>(items, bound<typename Traits::Args>(state, params));
}

template <class Traits>
Term describe()
{
    const FieldSet fields = Traits::fields();
    return {.name = Traits::name,
            .per = Traits::per,
            .nature = Traits::nature,
            .family = Traits::family,
            .fields = fields,
            .bytes_per_item = bytes_per_item(fields, kind_name(Traits::per)),
            .is_active = [](const Params& params) { return Traits::any_strength(Traits::values(params)); },
            .item_count = Traits::count,
            .add_force =
                [](State& state, const Params& params) {
                    const Items items = items_of(state, Traits::per);
                    run_stage<Traits>(state, params, items);
                    launch<Traits::force>(items, bound<typename Traits::Args>(state, params));
                },
            .add_stiffness =
                [](State& state, const Params& params, bool projected) {
                    const Items items = items_of(state, Traits::per);
                    run_stage<Traits>(state, params, items);
                    launch<Traits::stiffness>(items, bound<typename Traits::Args>(state, params, projected));
                },
            .energy_over =
                [](State& state, const Params& params, const Items& items) {
                    run_stage<Traits>(state, params, items);
                    return launch_sum<Traits::energy>(items, bound<typename Traits::Args>(state, params));
                }};
}

template <class Number>
void clear_slots(std::vector<Number>& field, int stride, const Items& items)
{
    if (items.list)
        clear(field, stride, items);
    else
        clear(field);
}

}  // namespace

Items all_items_of(const State& state, ItemKind kind)
{
    const mesh_sizes& size = state.size;
    const int counts[] = {size.vertex_count, size.face_count,   size.hinge_count,
                          size.stitch_count, size.spring_count, size.pair_count};
    return {counts[int(kind)]};
}

Items items_of(const State& state, ItemKind kind)
{
    const AwakeItems& awake = state.awake;
    if (awake.all) return all_items_of(state, kind);
    switch (kind) {
#define AWAKE(kind)      \
    case ItemKind::kind: \
        return {int(awake.kind.size()), awake.kind.data()};
        AWAKE(vertex)
        AWAKE(face)
        AWAKE(hinge)
        AWAKE(stitch)
        AWAKE(spring)
#undef AWAKE
        case ItemKind::pair:
            break;  // few, and between those awake and those asleep
    }
    return all_items_of(state, kind);
}

std::span<const Term> all_terms()
{
#define TERM(term, per, nature, stage, family) describe<term##_traits>(),
    static const Term terms[] = {TERMS(TERM)};
#undef TERM
    return terms;
}

std::string_view kind_name(ItemKind kind)
{
    constexpr std::string_view names[] = {"vertex", "face", "hinge", "stitch", "spring", "pair"};
    return names[int(kind)];
}

void clear_forces(State& state)
{
    clear_slots(state.force, state.size.vertex_stride, items_of(state, ItemKind::vertex));
#define CLEAR(kind, corners) clear_slots(state.kind##_force, state.size.kind##_stride, items_of(state, ItemKind::kind));
    GATHERED_KINDS(CLEAR)
#undef CLEAR
}

void clear_stiffness(State& state)
{
    clear_slots(state.vertex_stiffness, state.size.vertex_stride, items_of(state, ItemKind::vertex));
#define CLEAR(kind, corners) \
    clear_slots(state.kind##_stiffness, state.size.kind##_stride, items_of(state, ItemKind::kind));
    GATHERED_KINDS(CLEAR)
#undef CLEAR
}

void add_pair_diagonals(State& state)
{
    if (state.size.pair_count == 0) return;
    launch<pair_diagonal>(items_of(state, ItemKind::vertex),
                          pair_diagonal_args{pair_list_of(state), state.vertex_stiffness.data()});
}

void gather_forces(State& state)
{
#define GATHER(kind, corners)                                                                           \
    if (!state.kind##_force.empty())                                                                    \
        launch<gather_force>(                                                                           \
            items_of(state, ItemKind::vertex),                                                          \
            gather_args{state.kind##_slots.data(), state.kind##_slot.data(), state.kind##_force.data(), \
                        state.force.data(), state.size.vertex_stride, state.size.kind##_stride});
    GATHERED_KINDS(GATHER)
#undef GATHER
}

}  // namespace selvage
