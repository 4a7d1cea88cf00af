#pragma once
#include <vector>

#include "host/model/cloth_model.hpp"
#include "host/solver/state/topology.hpp"

namespace selvage {

/// The matrix G of kernels/terms/plate.h over the hinges of a cloth: energy = 1/2 phi^T G phi, symmetric, in
/// compressed rows that contain their diagonal.
struct PlateMatrix {
    std::vector<int> row_begin;  ///< Hinge count + 1.
    std::vector<int> column;     ///< Hinge; sorted within a row.
    std::vector<float> entry;    ///< [N m]
    std::vector<double> own;     ///< Diagonal W that stands for G in the assembled matrix, per hinge [N m].

    int entries() const { return int(column.size()); }
};

/// Finds G from the rest shapes: each face has the curvature tensor
///     S = sum_k (L_k / A) theta_k n_k n_k^T,      energy  A/2 S : C : S,
/// theta_k being the face's share of the turn of the hinge at its edge k. Shares are the combination of the turns of
/// the hinges around that gives every quadratic surface its exact side angles, nearest to the split by areas.
/// Free edges carry no moment; between held faces there are no hinges, and next to one the free face has the whole
/// turn; across a seam the panels are unfolded into one plane, and fabrics that differ do not share hinges.
/// Exact for constant curvature on any mesh, of second order otherwise.
/// @param cloth  in the numbering of the topology's faces; all fabrics of its panels must be in `fabrics`
PlateMatrix make_plate(const Topology& topology, const Cloth& cloth, const FabricTable& fabrics);

/// Copies the matrix into the fields of an allocated state.
void fill_plate(State& state, const PlateMatrix& plate);

}  // namespace selvage
