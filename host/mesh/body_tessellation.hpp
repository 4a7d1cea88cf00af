#pragma once
#include "io/geometry.hpp"

namespace selvage {

/// Returns an icosahedron refined `level` times, its vertices on the sphere: 20 * 4^level faces.
TriangleMesh sphere_mesh(const Vec3& center, double radius, int level);

/// Returns a square of the given width [m], counter-clockwise about its unit normal.
TriangleMesh square_mesh(const Vec3& center, const Vec3& normal, double width);

/// Returns the closed surface at distance `radius` from the segment between two distinct ends.
TriangleMesh capsule_mesh(const Vec3& first, const Vec3& last, double radius);

/// Returns an upright, closed cylinder with sharp rims, `segment_count` around, `center` in the middle of its axis.
/// The discs are graded: each ring towards their centre has half as many vertices.
/// @param segment_count  a power of two, >= 16
TriangleMesh cylinder_mesh(const Vec3& center, double radius, double height, int segment_count = 256);

/// Returns an upright, closed cone whose tip is a single vertex, `center` in the middle of its base.
/// @param segment_count  around the base, a power of two, >= 16
TriangleMesh cone_mesh(const Vec3& center, double radius, double height, int segment_count = 32);

/// Returns the surface at distance `tube` from the circle of the given radius about a unit axis; tube < radius.
TriangleMesh torus_mesh(const Vec3& center, const Vec3& axis, double radius, double tube);

/// Returns the enclosed volume [m^3], positive if the faces are counter-clockwise seen from outside.
double signed_volume(const TriangleMesh& mesh);

/// Returns for every vertex the first vertex with exactly the same position.
std::vector<int> first_coincident_vertex(const std::vector<Vec3>& vertices);

}  // namespace selvage
