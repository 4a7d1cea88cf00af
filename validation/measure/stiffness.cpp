#include "validation/measure/stiffness.hpp"

namespace selvage {
namespace {

using Triplets = std::vector<Eigen::Triplet<double>>;

template <class Vertices, class Slots>
void add_elements(int corners, int count, int stride, const Vertices& vertex, const Slots& slots, Triplets& to)
{
    for (int e = 0; e < count && !slots.empty(); ++e)
        for (int a = 0; a < corners; ++a)
            for (int b = a + 1; b < corners; ++b)
                for (int c = 0; c < 9; ++c) {
                    const double k = slots[9 * (std::size_t(block_index(corners, a, b)) * stride + e) + c];
                    const int va = 3 * vertex[a * stride + e], vb = 3 * vertex[b * stride + e];
                    to.emplace_back(va + c / 3, vb + c % 3, k);
                    to.emplace_back(vb + c % 3, va + c / 3, k);
                    // Translations cause no force, so each diagonal block is minus the sum of the others in its row.
                    to.emplace_back(va + c / 3, va + c % 3, -k);
                    to.emplace_back(vb + c % 3, vb + c / 3, -k);
                }
}

// Adds the blocks weight_a weight_b K of pairs in contact.
void add_pairs(const State& state, Triplets& entries)
{
    const int ps = state.size.pair_stride;
    for (int p = 0; p < state.size.pair_count; ++p)
        for (int ab = 0; ab < 16; ++ab) {
            const int a = ab / 4, b = ab % 4, va = state.pair_vertex[a * ps + p], vb = state.pair_vertex[b * ps + p];
            if (va < 0 || vb < 0) continue;
            for (int c = 0; c < 9; ++c) {
                const double contact =
                    state.pair_weight[a * ps + p] * state.pair_weight[b * ps + p] * state.pair_stiffness[9 * p + c];
                const double friction = state.pair_held_weight.empty()
                                            ? 0
                                            : state.pair_held_weight[a * ps + p] * state.pair_held_weight[b * ps + p] *
                                                  state.pair_stiffness[9 * (ps + p) + c];
                entries.emplace_back(3 * va + c / 3, 3 * vb + c % 3, contact + friction);
            }
        }
}

SparseMatrix couplings(const State& state)
{
    const int hinges = state.size.hinge_count, hs = state.size.hinge_stride, n = 3 * state.size.vertex_count;
    Triplets slopes, rest;
    for (int h = 0; h < hinges; ++h) {
        for (int c = 0; c < 12; ++c)
            slopes.emplace_back(h, 3 * state.hinge_vertex[c / 3 * hs + h] + c % 3, state.hinge_slope[12 * h + c]);
        for (int k = state.coupling_slots[h]; k < state.coupling_slots[hs + h]; ++k)
            rest.emplace_back(h, state.coupling_hinge[k], state.coupling_rigidity[k]);
        rest.emplace_back(h, h, -state.plate_diagonal[h]);
    }
    SparseMatrix j(hinges, n), g(hinges, hinges);
    j.setFromTriplets(slopes.begin(), slopes.end());
    g.setFromTriplets(rest.begin(), rest.end());
    const SparseMatrix moments = g * j;
    return SparseMatrix(j.transpose()) * moments;
}

}  // namespace

SparseMatrix slot_stiffness(const State& state, bool coupled)
{
    const int n = state.size.vertex_count;
    Triplets entries;
    for (int v = 0; v < n && !state.vertex_stiffness.empty(); ++v)
        for (int c = 0; c < 9; ++c)
            entries.emplace_back(3 * v + c / 3, 3 * v + c % 3, state.vertex_stiffness[9 * v + c]);
#define ADD(kind, corners)                                                                        \
    add_elements(corners, state.size.kind##_count, state.size.kind##_stride, state.kind##_vertex, \
                 state.kind##_stiffness, entries);
    ELEMENT_KINDS(ADD)
#undef ADD
    add_pairs(state, entries);
    SparseMatrix matrix(3 * n, 3 * n);
    matrix.setFromTriplets(entries.begin(), entries.end());
    if (coupled) matrix += couplings(state);
    return matrix;
}

SparseMatrix term_stiffness(const Term& term, State& state, const Params& params, bool projected)
{
    clear_stiffness(state);
    term.add_stiffness(state, params, projected);
    return slot_stiffness(state, term.fields[std::size_t(Field::hinge_slope)]);
}

SparseMatrix exact_stiffness(State& state, const Params& params)
{
    clear_stiffness(state);
    bool coupled = false;
    for (const Term& term : all_terms()) {
        if (!term.is_active(params) || term.nature != Nature::conservative) continue;
        term.add_stiffness(state, params, false);
        coupled = coupled || term.fields[std::size_t(Field::hinge_slope)];
    }
    return slot_stiffness(state, coupled);
}

SparseMatrix submatrix(const SparseMatrix& matrix, const std::vector<int>& kept)
{
    std::vector<int> place(matrix.cols(), -1);
    for (int i = 0; i < int(kept.size()); ++i) place[kept[i]] = i;
    Triplets entries;
    for (int column = 0; column < int(matrix.outerSize()); ++column)
        for (SparseMatrix::InnerIterator it(matrix, column); it; ++it)
            if (place[it.row()] >= 0 && place[column] >= 0)
                entries.emplace_back(place[it.row()], place[column], it.value());
    SparseMatrix result(int(kept.size()), int(kept.size()));
    result.setFromTriplets(entries.begin(), entries.end());
    return result;
}

}  // namespace selvage
