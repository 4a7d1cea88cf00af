#include "host/examine/file_mesh.hpp"

#include <algorithm>
#include <span>
#include <utility>

#include <fmt/format.h>
#include <Eigen/Geometry>

#include "host/mesh/polygon_triangles.hpp"
#include "io/number_text.hpp"

namespace selvage {
namespace {

std::string listed(std::span<const int> polygon)
{
    constexpr std::size_t most = 8;
    std::string text;
    for (std::size_t k = 0; k < std::min(polygon.size(), most); ++k)
        text += (k ? ", " : "") + std::to_string(polygon[k] + 1);
    return text + (polygon.size() > most ? ", ..." : "");
}

void refuse_repeated(const ObjMesh& obj, int p, std::vector<int>& sorted)
{
    const std::span<const int> polygon = obj.polygon(p);
    sorted.assign(polygon.begin(), polygon.end());
    std::sort(sorted.begin(), sorted.end());
    const auto twice = std::adjacent_find(sorted.begin(), sorted.end());
    if (twice == sorted.end()) return;
    throw InputError({obj.path, obj.polygon_lines[p], 0, {}},
                     fmt::format("a face ({}) that has vertex {} twice", listed(polygon), *twice + 1),
                     "each vertex once: without the repetition the face is smaller, or nothing");
}

[[noreturn]] void refuse_polygon(const ObjMesh& obj, int p, bool crosses)
{
    throw InputError({obj.path, obj.polygon_lines[p], 0, {}},
                     fmt::format("a face ({}) {}", listed(obj.polygon(p)),
                                 crosses ? "whose sides cross, or which has no area" : "without area"),
                     crosses ? "a face whose sides meet at its corners only, cut into triangles where it is not flat"
                             : "an area above 0 m^2; take the face out, or move its corners apart");
}

// The triangles of all polygons, with indices of the file.
void cut_all(const ObjMesh& obj, FileMesh& result, std::vector<int>& first_triangles)
{
    std::vector<std::array<int, 3>> triangles;
    std::vector<int> sorted;
    for (int p = 0; p < obj.polygon_count(); ++p) {
        first_triangles.push_back(int(result.mesh.faces.size()));
        refuse_repeated(obj, p, sorted);
        const std::span<const int> polygon = obj.polygon(p);
        triangles.clear();
        if (!split_polygon(obj.vertices, polygon, triangles)) refuse_polygon(obj, p, true);
        for (const auto& [a, b, c] : triangles) {
            result.mesh.faces.push_back({polygon[a], polygon[b], polygon[c]});
            result.face_polygons.push_back(p);
            if (obj.corner_textures.empty()) continue;
            const int* textures = obj.corner_textures.data() + obj.polygon_starts[p];
            result.face_textures.push_back({textures[a], textures[b], textures[c]});
        }
    }
    first_triangles.push_back(int(result.mesh.faces.size()));
}

// Keeps the vertices that faces use, in their order.
void leave_out_unused(const ObjMesh& obj, FileMesh& result, std::vector<Finding>& findings)
{
    std::vector<int> now(obj.vertices.size(), -1);
    for (const Face& face : result.mesh.faces)
        for (const int v : face) now[v] = 0;
    long long unused = 0;
    int first = -1;
    for (int v = 0; v < int(now.size()); ++v) {
        if (now[v] < 0) {
            if (unused++ == 0) first = v;
            continue;
        }
        now[v] = int(result.mesh.vertices.size());
        result.mesh.vertices.push_back(obj.vertices[v]);
        result.vertex_source.push_back(v);
    }
    for (Face& face : result.mesh.faces)
        for (int& v : face) v = now[v];
    if (unused == 0) return;
    findings.push_back(
        {"unused_vertex",
         {obj.path, obj.vertex_lines[first], 0, {}},
         unused == 1 ? fmt::format("vertex {} is used by no face and left out", first + 1)
                     : fmt::format("{} vertices are used by no face and left out, the first is {}", unused, first + 1),
         {},
         Severity::note});
}

}  // namespace

FileMesh cut_polygons(ObjMesh given, std::vector<Finding>& findings)
{
    FileMesh result;
    result.obj = std::move(given);
    const ObjMesh& obj = result.obj;
    std::vector<int> first_triangles;
    cut_all(obj, result, first_triangles);
    leave_out_unused(obj, result, findings);
    for (const MeshPart& part : obj.parts) {
        const int first = first_triangles[part.first_face];
        result.mesh.parts.push_back({part.name, first, first_triangles[part.first_face + part.face_count] - first});
    }
    const double least = least_area(result.mesh.vertices);
    for (std::size_t f = 0; f < result.mesh.faces.size(); ++f)
        if (!(area_of(result.mesh.vertices, result.mesh.faces[f]) > least))
            refuse_polygon(obj, result.face_polygons[f], false);
    return result;
}

std::string at_text(const Vec3& point)
{
    return " at (" + rounded_text(point.x()) + ", " + rounded_text(point.y()) + ", " + rounded_text(point.z()) + ") m";
}

std::string counted(long long count, const std::string& one, const std::string& many)
{
    return std::to_string(count) + " " + (count == 1 ? one : many);
}

double extent_of(const std::vector<Vec3>& vertices)
{
    Vec3 low = vertices.front(), high = low;
    for (const Vec3& x : vertices) {
        low = low.cwiseMin(x);
        high = high.cwiseMax(x);
    }
    return (high - low).maxCoeff();
}

double least_area(const std::vector<Vec3>& vertices)
{
    const double extent = extent_of(vertices);
    return 1e-14 * extent * extent;
}

double area_of(const std::vector<Vec3>& vertices, const Face& face)
{
    const Vec3& a = vertices[face[0]];
    return 0.5 * (vertices[face[1]] - a).cross(vertices[face[2]] - a).norm();
}

}  // namespace selvage
