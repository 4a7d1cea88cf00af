#include "io/mesh/body_mesh.hpp"

#include <algorithm>
#include <vector>

#include <Eigen/Geometry>

#include "io/errors.hpp"
#include "io/mesh/mesh_obj.hpp"
#include "io/number_text.hpp"

namespace selvage {
namespace {

// A body outside this range of sizes was probably read in a wrong unit [m]. The range covers a part of a human body as
// well as a room; it was chosen by hand.
constexpr double smallest_extent = 0.05, largest_extent = 5;

struct SortedEdge {
    int low, high;
    bool forward;  ///< The face runs from low to high.
};

std::vector<SortedEdge> sorted_edges(const TriangleMesh& mesh)
{
    std::vector<SortedEdge> edges;
    edges.reserve(3 * mesh.faces.size());
    for (const Face& face : mesh.faces)
        for (int corner = 0; corner < 3; ++corner) {
            const int a = face[corner], b = face[(corner + 1) % 3];
            edges.push_back({std::min(a, b), std::max(a, b), a < b});
        }
    std::sort(edges.begin(), edges.end(), [](const SortedEdge& a, const SortedEdge& b) {
        return a.low != b.low ? a.low < b.low : a.high < b.high;
    });
    return edges;
}

void count_edge(int& count, std::array<int, 2>& first, const SortedEdge& edge)
{
    if (count++ == 0) first = {edge.low, edge.high};
}

void check_edges(const TriangleMesh& mesh, BodyMeshReport& report)
{
    const std::vector<SortedEdge> edges = sorted_edges(mesh);
    for (std::size_t begin = 0, end = 0; begin < edges.size(); begin = end) {
        const SortedEdge& edge = edges[begin];
        int balance = 0;
        for (end = begin; end < edges.size() && edges[end].low == edge.low && edges[end].high == edge.high; ++end)
            balance += edges[end].forward ? 1 : -1;
        const std::size_t face_count = end - begin;
        if (face_count == 1) count_edge(report.boundary_edges, report.first_boundary_edge, edge);
        if (face_count > 2) count_edge(report.nonmanifold_edges, report.first_nonmanifold_edge, edge);
        if (face_count == 2 && balance != 0)
            count_edge(report.inconsistent_edges, report.first_inconsistent_edge, edge);
    }
}

void check_faces(const TriangleMesh& mesh, double extent, BodyMeshReport& report)
{
    // An area counts as zero if it is within the rounding error of coordinates of this extent.
    const double smallest_area = 1e-14 * extent * extent;
    for (int face = 0; face < int(mesh.faces.size()); ++face) {
        const auto [i, j, k] = mesh.faces[std::size_t(face)];
        const Vec3 &a = mesh.vertices[std::size_t(i)], &b = mesh.vertices[std::size_t(j)],
                   &c = mesh.vertices[std::size_t(k)];
        const Vec3 normal = (b - a).cross(c - a);
        report.volume += a.dot(b.cross(c)) / 6;
        if (normal.norm() > 2 * smallest_area) continue;
        if (report.zero_area_faces++ == 0) report.first_zero_area_face = face;
    }
}

int count_doubled(std::vector<Vec3> points)
{
    const auto before = [](const Vec3& a, const Vec3& b) {
        return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end());
    };
    std::sort(points.begin(), points.end(), before);
    int count = 0;
    for (std::size_t point = 1; point < points.size(); ++point) count += points[point] == points[point - 1];
    return count;
}

std::string at(const TriangleMesh& mesh, int vertex)
{
    std::string text = " at (";
    for (int axis = 0; axis < 3; ++axis)
        text += (axis ? ", " : "") + rounded_text(mesh.vertices[std::size_t(vertex)][axis]);
    return text + ") m";
}

std::string counted(int count, const std::string& one, const std::string& many)
{
    return std::to_string(count) + " " + (count == 1 ? one : many);
}

void require_size(const BodyMeshReport& report, const InputPlace& place)
{
    if (!report.size_looks_wrong) return;
    std::string unit;
    if (report.extent > largest_extent)
        unit = report.extent / 100 > largest_extent || report.extent / 1000 > 0.5 ? "unit = \"mm\"" : "unit = \"cm\"";
    throw InputError(place, "a body that measures " + rounded_text(report.extent) + " m",
                     "a body of " + range_text(smallest_extent, largest_extent, "m") + "; check its unit and scale",
                     unit);
}

}  // namespace

BodyMeshReport check_body_mesh(const TriangleMesh& mesh)
{
    BodyMeshReport report;
    if (mesh.vertices.empty()) return report;
    Vec3 low = mesh.vertices.front(), high = low;
    for (const Vec3& vertex : mesh.vertices) {
        low = low.cwiseMin(vertex);
        high = high.cwiseMax(vertex);
    }
    report.extent = (high - low).maxCoeff();
    report.size_looks_wrong = !(report.extent >= smallest_extent && report.extent <= largest_extent);
    report.doubled_vertices = count_doubled(mesh.vertices);
    check_faces(mesh, report.extent, report);
    check_edges(mesh, report);
    return report;
}

void require_closed_body(const TriangleMesh& mesh, const std::string& file)
{
    const BodyMeshReport report = check_body_mesh(mesh);
    const InputPlace place{file, 0, 0, {}};
    require_size(report, place);
    if (const int face = report.first_zero_area_face; face >= 0)
        throw InputError({file, obj_face_line(file, face), 0, "face " + std::to_string(face)},
                         counted(report.zero_area_faces, "triangle", "triangles") + " without area, the first" +
                             at(mesh, mesh.faces[std::size_t(face)][0]),
                         "triangles with an area above 0 m^2");
    if (report.boundary_edges > 0) {
        std::string expected = "a closed surface";
        if (report.doubled_vertices > 0)
            expected += "; " + std::to_string(report.doubled_vertices) + " vertices lie on others: join them first";
        throw InputError(place,
                         "a body with holes: " + counted(report.boundary_edges, "open edge", "open edges") +
                             ", the first" + at(mesh, report.first_boundary_edge[0]),
                         expected);
    }
    if (report.inconsistent_edges > 0)
        throw InputError(place,
                         "faces that disagree on the outside across " +
                             counted(report.inconsistent_edges, "edge", "edges") + ", the first" +
                             at(mesh, report.first_inconsistent_edge[0]),
                         "all faces counter-clockwise seen from outside");
    if (!(report.volume > 0))
        throw InputError(place, "faces that look inward (volume " + rounded_text(report.volume) + " m^3)",
                         "all faces counter-clockwise seen from outside");
}

}  // namespace selvage
