#pragma once
#include <string>
#include <vector>

#include "host/examine/file_mesh.hpp"
#include "io/finding.hpp"
#include "io/scene/scene.hpp"

namespace selvage {

/// Reads the OBJ file of a body or of one of its poses, in the size that `scale` gives it [m].
ObjMesh read_body(const BodyScene& given, const std::string& file);

/// Reads the OBJ file of a body and makes it the surface of a solid: joins vertices and closes holes as the scene asks,
/// and turns pieces outward if all of them look inward.
/// @param index     of the body in the scene
/// @param findings  gets what was found
/// @throws InputError for holes that are left, inner walls, faces that disagree on the outside, pieces inside out, an
/// odd size
FileMesh load_body(const Scene& scene, int index, const std::string& file, std::vector<Finding>& findings);

/// Requires that a body's surface is that of a solid: closed, its faces counter-clockwise seen from outside. If all of
/// its pieces look inward they are turned. Tells of triangles that intersect.
/// @param key       of the body in the scene, for the way on
/// @throws InputError as load_body
void examine_body(FileMesh& body, const std::string& key, std::vector<Finding>& findings);

/// Tells of a size that looks like another unit [m].
/// @param extent  longest side of the bounding box, with the scale of the scene
/// @throws InputError if no cloth could meet a body of that size
void examine_body_size(const Scene& scene, int index, const std::string& file, double extent,
                       std::vector<Finding>& findings);

}  // namespace selvage
