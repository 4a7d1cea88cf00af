#pragma once
#include <array>
#include <vector>

#include "host/render/camera.hpp"
#include "host/render/drawn_mesh.hpp"

namespace selvage {

/// Returns the points that must be in the picture: the vertices of the cloth and those of the bodies close to it.
/// Without cloth these are the vertices of the bodies, and with neither the origin.
/// @param meshes  mesh 0 is the cloth, the rest are bodies
std::vector<Vec3f> framed_points(const std::vector<DrawnMesh>& meshes);

/// Returns the directions of the two views.
/// @param points    what is framed
/// @param has_seams whether the cloth is sewn, and so has a front
std::array<ViewDirection, 2> view_directions(PictureViews views, bool has_seams, const std::vector<Vec3f>& points);

}  // namespace selvage
