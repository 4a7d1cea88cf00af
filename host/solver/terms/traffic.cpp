#include "host/solver/terms/traffic.hpp"

#include <algorithm>
#include <initializer_list>
#include <vector>

namespace selvage {
namespace {

std::size_t item_count(const mesh_sizes& size, std::string_view kind)
{
#define COUNT(name) \
    if (kind == #name) return std::size_t(size.name##_count);
    ITEM_KINDS(COUNT)
#undef COUNT
    return 0;
}

bool is_allocated(const State& state, Field field)
{
    switch (field) {
#define FIELD(type, name, per, components, unit, meaning) \
    case Field::name:                                     \
        return !state.name.empty();
#include "kernels/fields.def"
        case Field::count:
            break;
    }
    return false;
}

bool is_one_of(Field field, std::initializer_list<Field> fields)
{
    return std::find(fields.begin(), fields.end(), field) != fields.end();
}

#define FORCE_OF(kind, corners) , Field::kind##_force
#define STIFFNESS_OF(kind, corners) , Field::kind##_stiffness
#define LISTS_OF(kind, corners) Field::kind##_slots, Field::kind##_slot,
constexpr std::initializer_list<Field> forces = {Field::force GATHERED_KINDS(FORCE_OF)};
constexpr std::initializer_list<Field> stiffnesses = {Field::vertex_stiffness GATHERED_KINDS(STIFFNESS_OF)};
constexpr std::initializer_list<Field> gather_lists = {GATHERED_KINDS(LISTS_OF)};

std::size_t touched_vertices(const State& state, ItemKind kind)
{
    if (kind == ItemKind::vertex) return std::size_t(state.size.vertex_count);
    std::vector<char> touched(std::size_t(state.size.vertex_count), 0);
    const auto mark = [&](const std::vector<int>& vertex, int corners, int count, int stride) {
        for (int corner = 0; corner < corners && !vertex.empty(); ++corner)
            for (int item = 0; item < count; ++item)
                if (const int v = vertex[std::size_t(corner) * stride + item]; v >= 0) touched[std::size_t(v)] = 1;
    };
#define MARK(name, corners) \
    if (kind == ItemKind::name) mark(state.name##_vertex, corners, state.size.name##_count, state.size.name##_stride);
    GATHERED_KINDS(MARK)
#undef MARK
    return std::size_t(std::count(touched.begin(), touched.end(), 1));
}

}  // namespace

std::size_t pass_bytes(const State& state, std::initializer_list<Field> fields)
{
    std::size_t total = 0;
    for (Field field : fields)
        if (is_allocated(state, field))
            total += std::size_t(field_info(field).bytes_per_item) * item_count(state.size, field_info(field).per);
    return total;
}

std::size_t term_bytes(const Term& term, const State& state, TermPart part)
{
    const std::size_t vertices = touched_vertices(state, term.per);
    std::size_t total = 0;
    bool adds = part == TermPart::value;
    for (std::size_t f = 0; f < term.fields.size(); ++f) {
        if (!term.fields[f]) continue;
        const Field field = Field(f);
        const FieldInfo& info = field_info(field);
        const bool is_force = is_one_of(field, forces), is_stiffness = is_one_of(field, stiffnesses);
        const bool is_own = part == TermPart::force ? is_force : part == TermPart::stiffness && is_stiffness;
        if ((is_force || is_stiffness) && !is_own) continue;
        adds = adds || is_own;
        const std::size_t items = info.per == "vertex" ? vertices : item_count(state.size, info.per);
        total += std::size_t(info.bytes_per_item) * items * (is_own ? 2 : 1);
    }
    return adds ? total : 0;
}

std::size_t clear_forces_bytes(const State& state) { return pass_bytes(state, forces); }

std::size_t clear_stiffness_bytes(const State& state) { return pass_bytes(state, stiffnesses); }

std::size_t gather_list_bytes(const State& state) { return pass_bytes(state, gather_lists); }

std::size_t gather_bytes(const State& state)
{
    // Each kind is a pass of its own over the forces of the vertices.
    std::size_t total = gather_list_bytes(state) + pass_bytes(state, forces) - pass_bytes(state, {Field::force});
#define FORCE_PASS(kind, corners) \
    if (!state.kind##_force.empty()) total += 2 * pass_bytes(state, {Field::force});
    GATHERED_KINDS(FORCE_PASS)
#undef FORCE_PASS
    return total;
}

std::size_t settle_friction_bytes(const State& state)
{
    return pass_bytes(state, {Field::pos, Field::contact_normal, Field::contact_offset, Field::contact_area,
                              Field::contact_hardness, Field::contact_friction}) +
           2 * pass_bytes(state, {Field::friction_anchor, Field::friction_limit});
}

std::size_t settle_hysteresis_bytes(const State& state)
{
    return pass_bytes(state, {Field::pos, Field::hinge_vertex, Field::hinge_rest_sine, Field::hinge_width}) +
           2 * pass_bytes(state, {Field::hinge_anchor});
}

std::size_t body_query_bytes(const State& state)
{
    return pass_bytes(state, {Field::pos, Field::contact_normal, Field::contact_offset}) +
           std::size_t(state.size.vertex_count) * sizeof(int);
}

}  // namespace selvage
