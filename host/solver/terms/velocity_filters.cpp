#include "host/solver/terms/velocity_filters.hpp"

#include "host/parallel/launch.hpp"

namespace selvage {
namespace {

// One traits struct per line of kernels/velocity_filters.h. The macros below only list and bind; the logic is in
// templates.
#define LIST_FIELD(name) Field::name,
#define SET_FIELD(name) a.name = state.name.data();
#define SET_PARAM(name, initial, unit, meaning) a.name = values.name;
#define OR_NON_ZERO(name, initial, unit, meaning) || values.name != 0
#define IGNORE(name, initial, unit, meaning)
#define VELOCITY_FILTER(rule, kind)                                                                       \
    struct rule##_traits {                                                                                \
        static constexpr std::string_view name = #rule;                                                   \
        static constexpr ItemKind per = ItemKind::kind;                                                   \
        static constexpr auto kernel = rule##_apply;                                                      \
        static FieldSet fields() { return field_set({rule##_FIELDS(LIST_FIELD, LIST_FIELD)}); }           \
        static int count(const mesh_sizes& size) { return size.kind##_count; }                            \
        static const auto& values(const Params& params) { return params.rule; }                           \
        static bool any_strength(const auto& values) { return false rule##_PARAMS(OR_NON_ZERO, IGNORE); } \
        static void bind(rule##_args& a, State& state, const auto& values)                                \
        {                                                                                                 \
            a.size = state.size;                                                                          \
            rule##_FIELDS(SET_FIELD, SET_FIELD) rule##_PARAMS(SET_PARAM, SET_PARAM)                       \
        }                                                                                                 \
        using Args = rule##_args;                                                                         \
    };
VELOCITY_FILTERS(VELOCITY_FILTER)
#undef VELOCITY_FILTER

template <class Traits>
VelocityFilter describe()
{
    const FieldSet fields = Traits::fields();
    return {.name = Traits::name,
            .per = Traits::per,
            .fields = fields,
            .bytes_per_item = bytes_per_item(fields, kind_name(Traits::per)),
            .is_active = [](const Params& params) { return Traits::any_strength(Traits::values(params)); },
            .item_count = Traits::count,
            .apply =
                [](State& state, const Params& params, double dt) {
                    typename Traits::Args args{};
                    Traits::bind(args, state, Traits::values(params));
                    for_each_item(Traits::count(state.size), [args, dt](int item) { Traits::kernel(item, dt, &args); });
                }};
}

}  // namespace

std::span<const VelocityFilter> all_velocity_filters()
{
#define VELOCITY_FILTER(rule, per) describe<rule##_traits>(),
    static const VelocityFilter filters[] = {VELOCITY_FILTERS(VELOCITY_FILTER)};
#undef VELOCITY_FILTER
    return filters;
}

}  // namespace selvage
