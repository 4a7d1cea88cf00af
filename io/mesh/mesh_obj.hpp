#pragma once
#include <span>
#include <string>
#include <vector>

#include "io/choices.hpp"
#include "io/errors.hpp"
#include "io/geometry.hpp"

namespace selvage {

/// Reads a Wavefront OBJ file. Polygons become fans of triangles, `o` and `g` become parts; materials and normals are
/// ignored.
/// @param unit     length unit of the file
/// @param up_axis  up direction of the file
/// @param texture  if given: the texture coordinates per vertex as written, empty when the file has none
/// @return the mesh in metres, z up
/// @throws InputError with the line: bad numbers, indices out of range, faces below 3 vertices; a file without faces;
///         with `texture`, a vertex without texture coordinates or with several.
TriangleMesh read_obj(const std::string& path, LengthUnit unit, Axis up_axis, std::vector<Vec2>* texture = nullptr);

/// Returns the files that match a path with one * in its last part, sorted by name.
/// @param place  for error messages
/// @throws InputError if there is no *, or no such file
std::vector<std::string> sequence_files(const std::string& pattern, const InputPlace& place);

/// Returns the line of an OBJ file that holds a face of the mesh read from it; 0 if it cannot be found.
int obj_face_line(const std::string& path, int face);

/// An object of an OBJ file; indices count within it.
struct ObjObject {
    std::string name;
    std::span<const Vec3> positions;  ///< [m]
    std::span<const Face> faces;
    std::span<const Vec2> texture = {};  ///< Empty, or one per position.
    /// Empty, or for each position the one that it repeats, counted over all objects so far; -1: none. A position that
    /// repeats another one is not written again, so that the objects of a sewn garment stay connected.
    std::span<const int> repeated = {};
};

/// Writes an OBJ file; control characters in names become underscores. It is written under a temporary name and moves
/// it into place.
/// @throws InputError if the folder cannot be written
void write_obj(const std::string& path, std::span<const ObjObject> objects);

}  // namespace selvage
