#pragma once
#include <functional>

#include "io/geometry.hpp"

namespace selvage {

/// An implicit shape: negative inside, positive outside, roughly a distance [m] near its surface.
using ScalarField = std::function<double(const Vec3&)>;

struct SurfaceNetOptions {
    double spacing = 0.011;    ///< Grid spacing [m]; triangle edges come out about as long.
    double steepness = 1.4;    ///< Upper bound of |grad field|: blocks further than this from the surface are skipped.
    int smoothing_rounds = 8;  ///< Rounds of tangential relaxation, each followed by a projection.
};

/// Polygonises the zero set of `field` inside a box: a surface net (one vertex per cell that the surface
/// crosses, one quad per grid edge that it crosses), relaxed along the surface and projected onto it.
/// Grid signs are first made well-composed, so the result is a closed, outward oriented 2-manifold; gaps
/// narrower than about one grid cell may be filled. A field symmetric in x gives a symmetric grid.
/// Source: Gibson 1998, Constrained elastic surface nets; Latecki, Eckhardt, Rosenfeld 1995 (well-composed sets).
/// @param low, high  corners of the box [m]; the shape must lie inside it
TriangleMesh surface_net(const ScalarField& field, const Vec3& low, const Vec3& high,
                         const SurfaceNetOptions& options = {});

}  // namespace selvage
