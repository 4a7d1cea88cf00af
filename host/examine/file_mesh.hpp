#pragma once
#include <string>
#include <vector>

#include "io/finding.hpp"
#include "io/geometry.hpp"
#include "io/mesh/mesh_obj.hpp"

namespace selvage {

/// The triangles of a mesh file, over the vertices that a face uses, and where all of them stand in the file.
struct FileMesh {
    ObjMesh obj;                      ///< As the file has it.
    TriangleMesh mesh;                ///< [m]
    std::vector<int> vertex_source;   ///< Index of each vertex in the file, from 0.
    std::vector<int> face_polygons;   ///< Which polygon of the file a face was cut from; -1: it was made here.
    std::vector<Face> face_textures;  ///< Indices into obj.texture, -1 where a corner has none; empty without any.

    const std::string& file() const { return obj.path; }
    int number(int vertex) const { return vertex_source[std::size_t(vertex)] + 1; }  ///< In the file, from 1.
    int line_of(int vertex) const { return obj.vertex_lines[std::size_t(vertex_source[std::size_t(vertex)])]; }
    /// Line of a face in a file with the same polygons, this one or a pose; 0: the files do not have it.
    int line_of_face(const ObjMesh& in, int face) const
    {
        const int polygon = face_polygons[std::size_t(face)];
        return polygon < 0 ? 0 : in.polygon_lines[std::size_t(polygon)];
    }
    InputPlace at_face(int face) const { return {obj.path, line_of_face(obj, face), 0, {}}; }
    InputPlace at_vertex(int vertex) const { return {obj.path, line_of(vertex), 0, {}}; }
};

/// Cuts the polygons of a file into triangles and leaves out vertices that no face uses, which become a finding.
/// @throws InputError with the line: a face with a vertex twice, one that crosses itself or has no area
FileMesh cut_polygons(ObjMesh obj, std::vector<Finding>& findings);

/// Returns the place of a point for messages: ` at (x, y, z) m`.
std::string at_text(const Vec3& point);

/// Returns `1 triangle`, `2 triangles`.
std::string counted(long long count, const std::string& one, const std::string& many);

/// Returns the longest side of the bounding box [m].
double extent_of(const std::vector<Vec3>& vertices);

/// Returns the area below which a triangle of a mesh has none: the rounding error of coordinates of its size [m^2].
double least_area(const std::vector<Vec3>& vertices);

/// Returns the area of a triangle [m^2].
double area_of(const std::vector<Vec3>& vertices, const Face& face);

}  // namespace selvage
