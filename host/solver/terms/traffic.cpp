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

std::size_t pass_bytes(const State& state, std::initializer_list<Field> fields)
{
    std::size_t total = 0;
    for (Field field : fields)
        if (is_allocated(state, field))
            total += std::size_t(field_info(field).bytes_per_item) * item_count(state.size, field_info(field).per);
    return total;
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

std::size_t matrix_bytes(const BlockPattern& pattern)
{
    return std::size_t(pattern.blocks()) * (9 * sizeof(double) + sizeof(int)) + pattern.row_begin.size() * sizeof(int);
}

// Of one vector with three entries per row.
std::size_t vector_bytes(const BlockPattern& pattern) { return 3 * std::size_t(pattern.rows()) * sizeof(double); }

std::size_t entry_count(const Transfer& transfer)
{
    return std::size_t(std::count_if(transfer.weight.begin(), transfer.weight.end(), [](double w) { return w != 0; }));
}

// The pattern of P^T A P.
BlockPattern coarse_pattern(const BlockPattern& fine, const Transfer& up)
{
    const int rows = *std::max_element(up.column.begin(), up.column.end()) + 1;
    std::vector<std::vector<int>> down(rows);
    const auto for_each_coarse = [&up](int row, const auto& visit) {
        for (int k = up.offset[row]; k < up.offset[row + 1]; ++k)
            if (up.weight[k] != 0) visit(up.column[k]);
    };
    for (int row = 0; row < fine.rows(); ++row) for_each_coarse(row, [&](int coarse) { down[coarse].push_back(row); });

    BlockPattern pattern;
    pattern.row_begin.assign(1, 0);
    std::vector<int> seen_by(rows, -1);
    for (int row = 0; row < rows; ++row) {
        const auto add = [&](int column) {
            if (seen_by[column] != row) pattern.column.push_back(column);
            seen_by[column] = row;
        };
        add(row);
        for (int i : down[row])
            for (int k = fine.row_begin[i]; k < fine.row_begin[i + 1]; ++k) for_each_coarse(fine.column[k], add);
        pattern.row_begin.push_back(int(pattern.column.size()));
    }
    return pattern;
}

// Two smoothing steps before and after, the first of which needs no product: b, x, d and the inverse blocks are read,
// d and the new x written; the residual that goes down; restriction and interpolation.
std::size_t level_bytes(const BlockPattern& pattern, const Transfer& up, const BlockPattern& coarse)
{
    const std::size_t vector = vector_bytes(pattern), matrix = matrix_bytes(pattern);
    const std::size_t smoothing = 3 * (matrix + (3 + 5) * vector) + (3 + 3) * vector;
    const std::size_t residual = matrix + 3 * vector;
    const std::size_t interpolation = entry_count(up) * (sizeof(double) + sizeof(int));
    const std::size_t lists = (pattern.row_begin.size() + coarse.row_begin.size()) * sizeof(int);
    const std::size_t transfers = 2 * interpolation + lists + (1 + 2) * vector + 2 * vector_bytes(coarse);
    return smoothing + residual + transfers;
}

}  // namespace

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

std::size_t gather_bytes(const State& state)
{
    // Each kind is a pass of its own over the forces of the vertices.
    std::size_t total = pass_bytes(state, gather_lists) + pass_bytes(state, forces) - pass_bytes(state, {Field::force});
#define FORCE_PASS(kind, corners) \
    if (!state.kind##_force.empty()) total += 2 * pass_bytes(state, {Field::force});
    GATHERED_KINDS(FORCE_PASS)
#undef FORCE_PASS
    return total;
}

std::size_t settle_friction_bytes(const State& state)
{
    return pass_bytes(state, {Field::pos, Field::contact_normal, Field::contact_offset, Field::contact_area,
                              Field::contact_friction}) +
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

std::size_t assemble_bytes(const State& state, const BlockPattern& pattern)
{
    const std::size_t diagonal = 9 * std::size_t(pattern.rows()) * sizeof(double);
    const std::size_t places = pattern.face_place.size() + pattern.hinge_place.size() + pattern.stitch_place.size();
    return pass_bytes(state, stiffnesses) + pass_bytes(state, gather_lists) +
           pass_bytes(state, {Field::mass, Field::inv_mass}) + places * sizeof(std::uint16_t) + matrix_bytes(pattern) +
           2 * diagonal;
}

std::size_t product_bytes(const State& state, const BlockPattern& pattern)
{
    const std::size_t vector = vector_bytes(pattern);
    std::size_t total = matrix_bytes(pattern) + 2 * vector;
    if (!state.coupling_slots.empty()) {
        // Turns from slopes, moments from turns, and what these do to vertices; turns and moments are written and read.
        const std::size_t per_hinge = std::size_t(state.size.hinge_count) * sizeof(double);
        total += pass_bytes(state, {Field::hinge_vertex, Field::hinge_slope, Field::hinge_rigidity,
                                    Field::coupling_slots, Field::coupling_hinge, Field::coupling_rigidity,
                                    Field::hinge_slots, Field::hinge_slot, Field::hinge_slope}) +
                 4 * per_hinge + 3 * vector;
    }
    if (state.size.pair_count > 0) {
        // Relative places of both kinds of contact, written and read.
        const std::size_t relative = 6 * std::size_t(state.size.pair_count) * sizeof(double);
        const auto weights = {Field::pair_weight, Field::pair_held_weight};
        total += pass_bytes(state, {Field::pair_vertex, Field::pair_slots, Field::pair_slot, Field::pair_stiffness,
                                    Field::inv_mass}) +
                 2 * pass_bytes(state, weights) + 2 * relative + 4 * vector;
    }
    return total;
}

std::size_t block_jacobi_bytes(const BlockPattern& pattern) { return (3 + 2) * vector_bytes(pattern); }

std::size_t dot_bytes(const BlockPattern& pattern) { return 2 * vector_bytes(pattern); }

std::size_t update_bytes(const BlockPattern& pattern) { return 6 * vector_bytes(pattern); }

std::size_t multigrid_bytes(const BlockPattern& finest, const ParticleTransfers& transfers)
{
    if (transfers.empty()) return block_jacobi_bytes(finest);
    std::size_t total = 0;
    BlockPattern fine = finest;
    for (const Transfer& transfer : transfers) {
        BlockPattern coarse = coarse_pattern(fine, transfer);
        total += level_bytes(fine, transfer, coarse);
        fine = std::move(coarse);
    }
    // The two triangular solves of the coarsest level read half of a dense matrix each.
    const std::size_t unknowns = 3 * std::size_t(fine.rows());
    return total + unknowns * unknowns * sizeof(double) + 2 * vector_bytes(fine);
}

}  // namespace selvage
