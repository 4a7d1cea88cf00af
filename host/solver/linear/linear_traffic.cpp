#include "host/solver/linear/linear_traffic.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "host/solver/terms/traffic.hpp"

namespace selvage {
namespace {

std::size_t index_bytes(const BlockPattern& pattern)
{
    return (std::size_t(pattern.blocks()) + pattern.row_begin.size()) * sizeof(int);
}

std::size_t matrix_bytes(const BlockPattern& pattern, std::size_t scalar = sizeof(double))
{
    return std::size_t(pattern.blocks()) * 9 * scalar + index_bytes(pattern);
}

// Of one vector with three entries per row.
std::size_t vector_bytes(const BlockPattern& pattern) { return 3 * std::size_t(pattern.rows()) * sizeof(double); }

std::size_t entry_count(const Prolongation& prolongation)
{
    return std::size_t(
        std::count_if(prolongation.weight.begin(), prolongation.weight.end(), [](double w) { return w != 0; }));
}

// The pattern of P^T A P.
BlockPattern coarse_pattern(const BlockPattern& fine, const Prolongation& up)
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

// Entries of each row that are not zero.
std::vector<int> row_entries(const Prolongation& up)
{
    std::vector<int> entries;
    for (std::size_t row = 0; row + 1 < up.offset.size(); ++row) {
        const auto first = up.weight.begin();
        entries.push_back(
            int(std::count_if(first + up.offset[row], first + up.offset[row + 1], [](double w) { return w != 0; })));
    }
    return entries;
}

// Of an interpolation, its transpose, and the list of products that make the coarse matrix.
std::size_t connection_memory(const BlockPattern& fine, const Prolongation& up, int coarse_rows, std::size_t scalar)
{
    const std::vector<int> entries = row_entries(up);
    std::size_t products = 0;
    for (int row = 0; row < fine.rows(); ++row)
        for (int k = fine.row_begin[row]; k < fine.row_begin[row + 1]; ++k)
            products += std::size_t(entries[row]) * std::size_t(entries[fine.column[k]]);
    return products * sizeof(int) + 2 * entry_count(up) * (sizeof(int) + scalar) +
           std::size_t(fine.rows()) * sizeof(int) + std::size_t(coarse_rows) * (sizeof(int) + sizeof(std::size_t));
}

// Two smoothing steps before and after, the first of which needs no product: b, x, d and the inverse blocks are read,
// d and the new x written; the residual that goes down; restriction and interpolation.
std::size_t level_bytes(const BlockPattern& pattern, const Prolongation& up, const BlockPattern& coarse)
{
    const std::size_t vector = vector_bytes(pattern), matrix = matrix_bytes(pattern);
    const std::size_t smoothing = 3 * (matrix + (3 + 5) * vector) + (3 + 3) * vector;
    const std::size_t residual = matrix + 3 * vector;
    const std::size_t interpolation = entry_count(up) * (sizeof(double) + sizeof(int));
    const std::size_t lists = (pattern.row_begin.size() + coarse.row_begin.size()) * sizeof(int);
    const std::size_t prolongations = 2 * interpolation + lists + (1 + 2) * vector + 2 * vector_bytes(coarse);
    return smoothing + residual + prolongations;
}

}  // namespace

std::size_t assemble_bytes(const State& state, const BlockPattern& pattern)
{
    const std::size_t diagonal = 9 * std::size_t(pattern.rows()) * sizeof(double);
    return clear_stiffness_bytes(state) + gather_list_bytes(state) + pass_bytes(state, {Field::mass, Field::inv_mass}) +
           pattern.place_bytes() + matrix_bytes(pattern) + 2 * diagonal;
}

std::size_t product_bytes(const State& state, const BlockPattern& pattern)
{
    const std::size_t vector = vector_bytes(pattern);
    std::size_t total = matrix_bytes(pattern) + 2 * vector;
    if (!state.coupling_slots.empty()) {
        // Turns from slopes, moments from turns, and what these do to vertices; turns and moments are written and read.
        const std::size_t per_hinge = std::size_t(state.size.hinge_count) * sizeof(double);
        total += pass_bytes(state, {Field::hinge_vertex, Field::hinge_slope, Field::plate_diagonal,
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

std::size_t multigrid_bytes(const BlockPattern& finest, const ParticleProlongations& prolongations)
{
    if (prolongations.empty()) return block_jacobi_bytes(finest);
    std::size_t total = 0;
    BlockPattern fine = finest;
    for (const Prolongation& prolongation : prolongations) {
        BlockPattern coarse = coarse_pattern(fine, prolongation);
        total += level_bytes(fine, prolongation, coarse);
        fine = std::move(coarse);
    }
    // The two triangular solves of the coarsest level read half of a dense matrix each.
    const std::size_t unknowns = 3 * std::size_t(fine.rows());
    return total + unknowns * unknowns * sizeof(double) + 2 * vector_bytes(fine);
}

BlockPattern pattern_of(const Topology& topology, bool bends)
{
    std::vector<std::vector<int>> columns(std::size_t(topology.particle_count));
    const auto add = [&](int a, int b) {
        columns[a].push_back(b);
        columns[b].push_back(a);
    };
    for (const Face& f : topology.faces)
        for (int k = 0; k < 3; ++k) add(f[k], f[(k + 1) % 3]);
    for (const auto& [a, b] : topology.stitches) add(a, b);
    for (const Spring& spring : topology.springs) add(spring.vertex[0], spring.vertex[1]);
    if (bends)
        for (const std::array<int, 4>& hinge : topology.hinges) add(hinge[2], hinge[3]);
    BlockPattern pattern;
    pattern.row_begin.assign(1, 0);
    for (int row = 0; row < topology.particle_count; ++row) {
        std::vector<int>& own = columns[row];
        own.push_back(row);
        std::sort(own.begin(), own.end());
        own.erase(std::unique(own.begin(), own.end()), own.end());
        pattern.column.insert(pattern.column.end(), own.begin(), own.end());
        pattern.row_begin.push_back(int(pattern.column.size()));
    }
    return pattern;
}

std::size_t linear_solver_bytes(const BlockPattern& finest, const ParticleProlongations& prolongations,
                                std::size_t scalar)
{
    const std::size_t vector = 3 * scalar, diagonal = 9 * scalar;
    std::size_t total =
        matrix_bytes(finest, scalar) + index_bytes(finest) + std::size_t(finest.rows()) * (5 * vector + diagonal);
    if (prolongations.empty()) return total;
    BlockPattern fine = finest;
    for (const Prolongation& prolongation : prolongations) {
        BlockPattern coarse = coarse_pattern(fine, prolongation);
        total += connection_memory(fine, prolongation, coarse.rows(), scalar) + matrix_bytes(coarse, scalar) +
                 std::size_t(coarse.rows()) * (4 * vector + diagonal);
        fine = std::move(coarse);
    }
    return total + std::size_t(finest.rows()) * 3 * vector;
}

}  // namespace selvage
