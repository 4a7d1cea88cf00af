#include "host/solver/terms/terms.hpp"

#include <type_traits>

#include "host/parallel/launch.hpp"
#include "host/solver/state/pair_list.hpp"
#include "kernels/stages/gather.h"

namespace selvage {
namespace {

constexpr std::nullptr_t no_stage = nullptr;

// One traits struct per line of kernels/terms.h. The macros below only list and bind; the logic is in templates.
#define LIST_FIELD(name) Field::name,
#define SET_READ(name) a.name = state.name.data();
#define SET_ADD(name) a.name = state.name.data();
#define SET_PARAM(name, initial, unit, meaning) a.name = values.name;
#define OR_NON_ZERO(name, initial, unit, meaning) || values.name != 0
#define IGNORE(name, initial, unit, meaning)
#define TERM(term, kind, nature_of_term, stage_before)                                                    \
    struct term##_traits {                                                                                \
        static constexpr std::string_view name = #term;                                                   \
        static constexpr ItemKind per = ItemKind::kind;                                                   \
        static constexpr Nature nature = Nature::nature_of_term;                                          \
        static FieldSet fields() { return field_set({term##_FIELDS(LIST_FIELD, LIST_FIELD)}); }           \
        static constexpr auto stage = stage_before;                                                       \
        static constexpr auto force = term##_force;                                                       \
        static constexpr auto stiffness = term##_stiffness;                                               \
        static constexpr auto energy = term##_energy;                                                     \
        static int count(const mesh_sizes& size) { return size.kind##_count; }                            \
        static const auto& values(const Params& params) { return params.term; }                           \
        static bool any_strength(const auto& values) { return false term##_PARAMS(OR_NON_ZERO, IGNORE); } \
        static void bind(term##_args& a, State& state, const auto& values)                                \
        {                                                                                                 \
            a.size = state.size;                                                                          \
            term##_FIELDS(SET_READ, SET_ADD) term##_PARAMS(SET_PARAM, SET_PARAM)                          \
        }                                                                                                 \
        using Args = term##_args;                                                                         \
    };
TERMS(TERM)
#undef TERM

template <class Traits>
typename Traits::Args bound(State& state, const Params& params, bool projected = false)
{
    typename Traits::Args args;
    args.mode.projected = projected;
    Traits::bind(args, state, Traits::values(params));
    return args;
}

template <class Traits>
void run_stage(State& state, const Params& params, const Items& items)
{
    if constexpr (!std::is_null_pointer_v<decltype(Traits::stage)>)
        launch<Traits::stage>(items, bound<Traits>(state, params));
}

template <class Traits>
Term describe()
{
    const FieldSet fields = Traits::fields();
    return {.name = Traits::name,
            .per = Traits::per,
            .nature = Traits::nature,
            .fields = fields,
            .bytes_per_item = bytes_per_item(fields, kind_name(Traits::per)),
            .is_active = [](const Params& params) { return Traits::any_strength(Traits::values(params)); },
            .item_count = Traits::count,
            .add_force =
                [](State& state, const Params& params) {
                    const Items items = items_of(state, Traits::per);
                    run_stage<Traits>(state, params, items);
                    launch<Traits::force>(items, bound<Traits>(state, params));
                },
            .add_stiffness =
                [](State& state, const Params& params, bool projected) {
                    const Items items = items_of(state, Traits::per);
                    run_stage<Traits>(state, params, items);
                    launch<Traits::stiffness>(items, bound<Traits>(state, params, projected));
                },
            .energy =
                [](State& state, const Params& params) {
                    const Items items = items_of(state, Traits::per);
                    run_stage<Traits>(state, params, items);
                    return launch_sum<Traits::energy>(items, bound<Traits>(state, params));
                }};
}

// Planes of a field of which only some items are to be cleared.
void clear_items(std::vector<real>& field, int stride, const Items& items)
{
    const int planes = stride > 0 ? int(field.size()) / stride : 0;
    for_each_item(items, [to = field.data(), planes, stride](int item) {
        for (int p = 0; p < planes; ++p) to[p * stride + item] = 0;
    });
}

// The same for blocks of nine.
void clear_items(std::vector<block_real>& field, int stride, const Items& items)
{
    const int blocks = stride > 0 ? int(field.size()) / (9 * stride) : 0;
    for_each_item(items, [to = field.data(), blocks, stride](int item) {
        for (int b = 0; b < blocks; ++b)
            for (int c = 0; c < 9; ++c) to[9 * (b * stride + item) + c] = 0;
    });
}

template <class Number>
void clear_slots(std::vector<Number>& field, int stride, const Items& items)
{
    if (items.list)
        clear_items(field, stride, items);
    else
        for_each_item(int(field.size()), [to = field.data()](int i) { to[i] = 0; });
}

}  // namespace

Items items_of(const State& state, ItemKind kind)
{
    const AwakeItems& awake = state.awake;
    switch (kind) {
#define AWAKE(kind)      \
    case ItemKind::kind: \
        return awake.all ? Items{state.size.kind##_count} : Items{int(awake.kind.size()), awake.kind.data()};
        AWAKE(vertex)
        AWAKE(face)
        AWAKE(hinge)
        AWAKE(stitch)
        AWAKE(spring)
#undef AWAKE
        case ItemKind::pair:
            break;  // few, and between those awake and those asleep
    }
    return {state.size.pair_count};
}

std::span<const Term> all_terms()
{
#define TERM(term, per, nature, stage) describe<term##_traits>(),
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
