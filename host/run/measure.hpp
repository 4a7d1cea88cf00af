#pragma once
#include <array>
#include <string>
#include <vector>

#include "host/model/cloth.hpp"
#include "host/solver/stepping/phase.hpp"

namespace selvage {

/// Principal stretches minus one over all faces, in each face's own rest plane [1].
struct StretchMeasure {
    double min = 0, max = 0;
    double p99 = 0;     ///< Magnitude below which 99 % of the principal stretches lie.
    int max_face = -1;  ///< Whose the largest is, the first of them; -1: without faces.
};

/// A principal stretch minus one [1], and whose it is.
struct FaceStretch {
    double stretch = 0;
    int face = -1;    ///< Of the cloth; -1: none.
    double time = 0;  ///< [s]
};

/// How much sewing and draping changed a panel: |now - flat| / flat [1].
struct PanelMeasure {
    std::string name;
    double area_error = 0, boundary_error = 0;
};

/// @param rest_corners  (weft, warp) of the corners of every face [m]
/// @param faces         corners as indices of positions
/// @param positions     [m]
StretchMeasure measure_stretch(const std::vector<std::array<Vec2, 3>>& rest_corners, const std::vector<Face>& faces,
                               const std::vector<Vec3>& positions);

/// Finds the largest principal stretch of all faces and the first face that has it, on all cores.
/// @param above  what it has to exceed: else the result has no face
FaceStretch largest_stretch(const Cloth& cloth, const std::vector<Vec3>& positions, double above);

/// The same of a cloth where its phase has it now.
FaceStretch largest_stretch(const Cloth& cloth, const Phase& phase, double above);

std::vector<PanelMeasure> measure_panels(const Cloth& cloth, const std::vector<Vec3>& positions);

/// Largest distance of a sewn pair [m].
double measure_seam_gap(const Cloth& cloth, const std::vector<Vec3>& positions);

/// A seam whose sides are apart.
struct OpenSeam {
    int seam = 0;    ///< Of Cloth::seams.
    int pair = 0;    ///< Of Cloth::seam_pairs: the one that is furthest apart.
    double gap = 0;  ///< Between its vertices [m].
};

/// The seams that are not closed, the widest first.
std::vector<OpenSeam> open_seams(const Cloth& cloth, const std::vector<Vec3>& positions);

/// The sides of a seam, as `front[3]`: panel and edge.
std::array<std::string, 2> seam_sides(const Cloth& cloth, int seam);

/// The (weft, warp) coordinates of the corners of every outward face in its own panel, in single precision [m].
std::vector<std::array<Vec2, 3>> rest_corners(const Cloth& cloth);

/// The panel of every face.
std::vector<int> face_panels(const Cloth& cloth);

/// Rest lengths of the edges 01, 12, 20 of every outward face [m].
std::vector<std::array<double, 3>> rest_edge_lengths(const Cloth& cloth);

}  // namespace selvage
