#pragma once
#include <span>
#include <string>
#include <vector>

#include "io/choices.hpp"
#include "io/errors.hpp"
#include "io/geometry.hpp"

namespace selvage {

/// What an OBJ file says: its points, and polygons over them. Nothing is judged but that numbers are finite and that
/// indices exist.
struct ObjMesh {
    std::string path;
    std::vector<Vec3> vertices;        ///< [m], z up.
    std::vector<int> vertex_lines;     ///< Where they stand in the file, from 1.
    std::vector<Vec2> texture;         ///< As written.
    std::vector<int> polygon_starts;   ///< First corner of each polygon, and at the end the number of all corners.
    std::vector<int> polygon_lines;    ///< Where they stand in the file, from 1.
    std::vector<int> corner_vertices;  ///< Of all polygons.
    std::vector<int> corner_textures;  ///< -1: none. Empty if no corner has any.
    std::vector<MeshPart> parts;       ///< Runs of polygons under one `o` or `g`; cover all of them, or empty.

    int polygon_count() const { return int(polygon_lines.size()); }
    std::span<const int> polygon(int index) const
    {
        const int first = polygon_starts[std::size_t(index)], end = polygon_starts[std::size_t(index) + 1];
        return {corner_vertices.data() + first, std::size_t(end - first)};
    }
};

/// Reads a Wavefront OBJ file. `o` and `g` become parts; materials, normals, colours and lines are ignored.
/// @param unit     length unit of the file
/// @param up_axis  up direction of the file
/// @throws InputError with the line: bad numbers, indices out of range, faces below 3 vertices; a file without faces
ObjMesh read_obj(const std::string& path, LengthUnit unit, Axis up_axis);

/// A file of a sequence.
struct SequenceFile {
    std::string path;
    long long number = -1;  ///< What stands for the *; -1 if that is no number.
};

/// Returns the files that match a path with one * in its last part: by number where that is one, then by name.
/// @param place  for error messages
/// @throws InputError if there is no *, or no such file, or if two files have the same number
std::vector<SequenceFile> sequence_files(const std::string& pattern, const InputPlace& place);

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
