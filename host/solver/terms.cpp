#include "host/solver/terms.hpp"

#include <type_traits>

#include "host/solver/launch.hpp"
#include "host/solver/pair_list.hpp"
#include "host/solver/rules.hpp"
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
#define TERM(term, kind, nature_of_term, stage_before)                                                                    \
    struct term##_traits {                                                                                  \
        static constexpr std::string_view name = #term;                                                     \
        static constexpr ItemKind per = ItemKind::kind;                                                     \
        static constexpr Nature nature = Nature::nature_of_term;                                            \
        static FieldSet fields() { return field_set({term##_FIELDS(LIST_FIELD, LIST_FIELD)}); }                \
        static constexpr auto stage = stage_before;                                                         \
        static constexpr auto force = term##_force;                                                         \
        static constexpr auto stiffness = term##_stiffness;                                                 \
        static constexpr auto energy = term##_energy;                                                       \
        static int count(const mesh_sizes& size) { return size.kind##_count; }                              \
        static const auto& values(const Params& params) { return params.term; }                             \
        static bool any_strength(const auto& values) { return false term##_PARAMS(OR_NON_ZERO, IGNORE); }   \
        static void bind(term##_args& a, State& state, const auto& values)                                   \
        {                                                                                                   \
            a.size = state.size;                                                                            \
            term##_FIELDS(SET_READ, SET_ADD) term##_PARAMS(SET_PARAM, SET_PARAM)                            \
        }                                                                                                   \
        using Args = term##_args;                                                                           \
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
void run_stage(State& state, const Params& params)
{
    if constexpr (!std::is_null_pointer_v<decltype(Traits::stage)>)
        launch<Traits::stage>(Traits::count(state.size), bound<Traits>(state, params));
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
                    run_stage<Traits>(state, params);
                    launch<Traits::force>(Traits::count(state.size), bound<Traits>(state, params));
                },
            .add_stiffness =
                [](State& state, const Params& params, bool projected) {
                    run_stage<Traits>(state, params);
                    launch<Traits::stiffness>(Traits::count(state.size), bound<Traits>(state, params, projected));
                },
            .energy =
                [](State& state, const Params& params) {
                    run_stage<Traits>(state, params);
                    return launch_sum<Traits::energy>(Traits::count(state.size), bound<Traits>(state, params));
                }};
}

#define GATHER_FIELDS(kind, corners)                                     \
    if (fields[std::size_t(Field::kind##_force)]) {                      \
        fields.set(std::size_t(Field::kind##_slots));                    \
        fields.set(std::size_t(Field::kind##_slot));                     \
    }

}  // namespace

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

FieldSet required_fields(const Params& params)
{
    FieldSet fields = field_set({Field::pos, Field::vel, Field::mass, Field::inv_mass, Field::force});
    for (const Term& term : all_terms())
        if (term.is_active(params)) fields |= term.fields;
    for (const Rule& rule : all_rules())
        if (rule.is_active(params)) fields |= rule.fields;
    GATHERED_KINDS(GATHER_FIELDS)
    return fields;
}

void clear_forces(State& state)
{
    const auto clear = [](std::vector<real>& field) {
        for_each_item(int(field.size()), [to = field.data()](int i) { to[i] = 0; });
    };
    clear(state.force);
#define CLEAR(kind, corners) clear(state.kind##_force);
    GATHERED_KINDS(CLEAR)
#undef CLEAR
}

void clear_stiffness(State& state)
{
    const auto clear = [](std::vector<block_real>& field) {
        for_each_item(int(field.size()), [to = field.data()](int i) { to[i] = 0; });
    };
    clear(state.vertex_stiffness);
#define CLEAR(kind, corners) clear(state.kind##_stiffness);
    GATHERED_KINDS(CLEAR)
#undef CLEAR
}

void add_pair_diagonals(State& state)
{
    if (state.size.pair_count == 0) return;
    launch<pair_diagonal>(state.size.vertex_count,
                          pair_diagonal_args{pair_list_of(state), state.vertex_stiffness.data()});
}

void gather_forces(State& state)
{
#define GATHER(kind, corners)                                                                                  \
    if (!state.kind##_force.empty())                                                                           \
        launch<gather_force>(state.size.vertex_count,                                                          \
                             gather_args{state.kind##_slots.data(), state.kind##_slot.data(),                  \
                                         state.kind##_force.data(), state.force.data(),                        \
                                         state.size.vertex_stride, state.size.kind##_stride});
    GATHERED_KINDS(GATHER)
#undef GATHER
}

}  // namespace selvage
