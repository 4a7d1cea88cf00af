#include "host/mesh/body_tessellation.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <tuple>
#include <utility>

#include <tbb/parallel_sort.h>
#include <Eigen/Geometry>

namespace selvage {
namespace {

constexpr double pi = std::numbers::pi;

TriangleMesh icosahedron()
{
    const double g = std::numbers::phi;
    TriangleMesh mesh;
    mesh.vertices = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                     {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
    mesh.faces = {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                  {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                  {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
    for (Vec3& vertex : mesh.vertices) vertex.normalize();
    return mesh;
}

/// Replaces each face by four, with the new vertices pushed out to the unit sphere.
void refine_unit_sphere(TriangleMesh& mesh)
{
    std::map<std::pair<int, int>, int> middle;
    const auto middle_of = [&](int a, int b) {
        const auto [place, is_new] = middle.try_emplace(std::minmax(a, b), int(mesh.vertices.size()));
        if (is_new) mesh.vertices.push_back((mesh.vertices[a] + mesh.vertices[b]).normalized());
        return place->second;
    };
    std::vector<Face> refined;
    refined.reserve(4 * mesh.faces.size());
    for (const Face& f : mesh.faces) {
        const int ab = middle_of(f[0], f[1]), bc = middle_of(f[1], f[2]), ca = middle_of(f[2], f[0]);
        refined.insert(refined.end(), {{f[0], ab, ca}, {f[1], bc, ab}, {f[2], ca, bc}, {ab, bc, ca}});
    }
    mesh.faces = std::move(refined);
}

/// Adds a horizontal circle of vertices and returns its first index.
int add_ring(TriangleMesh& mesh, const Vec3& center, double radius, int count)
{
    const int first = int(mesh.vertices.size());
    for (int k = 0; k < count; ++k) {
        const double angle = 2 * pi * k / count;
        mesh.vertices.push_back(center + radius * Vec3(std::cos(angle), std::sin(angle), 0));
    }
    return first;
}

/// Joins two rings of equal count by triangles whose outside faces away from the axis; `lower` is below `upper`.
void join_rings(TriangleMesh& mesh, int lower, int upper, int count)
{
    for (int k = 0; k < count; ++k) {
        const int next = (k + 1) % count;
        mesh.faces.push_back({lower + k, lower + next, upper + next});
        mesh.faces.push_back({lower + k, upper + next, upper + k});
    }
}

void add_face(TriangleMesh& mesh, int a, int b, int c, bool reversed)
{
    if (reversed) std::swap(b, c);
    mesh.faces.push_back({a, b, c});
}

/// Fills the circle of vertices `ring` with concentric rings, each with half as many vertices. `upward`: the outside of
/// the disc is above.
void add_disc(TriangleMesh& mesh, const Vec3& center, double radius, int ring, int count, bool upward)
{
    while (count > 8) {
        radius -= 1.2 * 2 * pi * radius / count;  // the rings are about as far apart as their vertices
        const int half = count / 2, inner = add_ring(mesh, center, radius, half);
        for (int k = 0; k < half; ++k) {
            const int a = ring + 2 * k, b = a + 1, c = ring + (2 * k + 2) % count;
            const int p = inner + k, q = inner + (k + 1) % half;
            add_face(mesh, a, b, p, !upward);
            add_face(mesh, b, q, p, !upward);
            add_face(mesh, b, c, q, !upward);
        }
        ring = inner;
        count = half;
    }
    const int middle = int(mesh.vertices.size());
    mesh.vertices.push_back(center);
    for (int k = 0; k < count; ++k) add_face(mesh, ring + k, ring + (k + 1) % count, middle, !upward);
}

}  // namespace

TriangleMesh sphere_mesh(const Vec3& center, double radius, int level)
{
    TriangleMesh mesh = icosahedron();
    for (int k = 0; k < level; ++k) refine_unit_sphere(mesh);
    for (Vec3& vertex : mesh.vertices) vertex = center + radius * vertex;
    return mesh;
}

TriangleMesh square_mesh(const Vec3& center, const Vec3& normal, double width)
{
    const Vec3 u = normal.unitOrthogonal() * (width / 2), v = normal.cross(u);
    TriangleMesh mesh;
    mesh.vertices = {center - u - v, center + u - v, center + u + v, center - u + v};
    mesh.faces = {{0, 1, 2}, {0, 2, 3}};
    return mesh;
}

TriangleMesh capsule_mesh(const Vec3& first, const Vec3& last, double radius)
{
    constexpr int around = 96, cap_rings = 24;
    const double length = (last - first).norm();
    TriangleMesh mesh;
    mesh.vertices.push_back({0, 0, -radius});
    for (const double end : {0.0, length})
        for (int k = 0; k < cap_rings; ++k) {
            const double latitude = pi / 2 * (end == 0 ? k + 1 - cap_rings : k) / cap_rings;
            add_ring(mesh, {0, 0, end + radius * std::sin(latitude)}, radius * std::cos(latitude), around);
        }
    const int top = int(mesh.vertices.size());
    mesh.vertices.push_back({0, 0, length + radius});

    const int last_ring = top - around;
    for (int k = 0; k < around; ++k) {
        const int next = (k + 1) % around;
        mesh.faces.push_back({0, 1 + next, 1 + k});
        mesh.faces.push_back({top, last_ring + k, last_ring + next});
    }
    for (int ring = 1; ring < last_ring; ring += around) join_rings(mesh, ring, ring + around, around);

    const Eigen::Quaterniond turn = Eigen::Quaterniond::FromTwoVectors(Vec3::UnitZ(), last - first);
    for (Vec3& vertex : mesh.vertices) vertex = first + turn * vertex;
    return mesh;
}

TriangleMesh cylinder_mesh(const Vec3& center, double radius, double height, int segment_count)
{
    const double segment = 2 * pi * radius / segment_count;
    const int row_count = int(std::clamp(std::round(height / (4 * segment)), 1.0, 64.0));
    const Vec3 bottom_center = center - Vec3(0, 0, height / 2), top_center = center + Vec3(0, 0, height / 2);
    TriangleMesh mesh;
    const int bottom = add_ring(mesh, bottom_center, radius, segment_count);
    int top = bottom;
    for (int row = 1; row <= row_count; ++row) {
        const Vec3 row_center = bottom_center + (top_center - bottom_center) * (double(row) / row_count);
        const int next = add_ring(mesh, row_center, radius, segment_count);
        join_rings(mesh, top, next, segment_count);
        top = next;
    }
    add_disc(mesh, top_center, radius, top, segment_count, true);
    add_disc(mesh, bottom_center, radius, bottom, segment_count, false);
    return mesh;
}

TriangleMesh cone_mesh(const Vec3& center, double radius, double height, int segment_count)
{
    constexpr int rows = 16;  // row heights shrink towards the tip in proportion to the rings' edges
    TriangleMesh mesh;
    const int base = add_ring(mesh, center, radius, segment_count);
    int lower = base;
    for (int row = 1; row < rows; ++row) {
        const double left = std::pow(0.8, row);
        const int upper = add_ring(mesh, center + Vec3(0, 0, (1 - left) * height), left * radius, segment_count);
        join_rings(mesh, lower, upper, segment_count);
        lower = upper;
    }
    const int tip = int(mesh.vertices.size());
    mesh.vertices.push_back(center + Vec3(0, 0, height));
    for (int k = 0; k < segment_count; ++k) mesh.faces.push_back({lower + k, lower + (k + 1) % segment_count, tip});
    add_disc(mesh, center, radius, base, segment_count, false);
    return mesh;
}

TriangleMesh torus_mesh(const Vec3& center, const Vec3& axis, double radius, double tube)
{
    constexpr int around = 128, across = 32;
    const Eigen::Quaterniond turn = Eigen::Quaterniond::FromTwoVectors(Vec3::UnitZ(), axis);
    TriangleMesh mesh;
    for (int i = 0; i < around; ++i)
        for (int j = 0; j < across; ++j) {
            const double u = 2 * pi * i / around, v = 2 * pi * j / across, r = radius + tube * std::cos(v);
            mesh.vertices.push_back(center + turn * Vec3(r * std::cos(u), r * std::sin(u), tube * std::sin(v)));
        }
    for (int i = 0; i < around; ++i)
        for (int j = 0; j < across; ++j) {
            const int next = (i + 1) % around, up = (j + 1) % across;
            const int a = i * across + j, b = next * across + j, c = next * across + up, d = i * across + up;
            mesh.faces.push_back({a, b, c});
            mesh.faces.push_back({a, c, d});
        }
    return mesh;
}

double signed_volume(const TriangleMesh& mesh)
{
    double six_volumes = 0;
    if (mesh.vertices.empty()) return 0;
    const Vec3 origin = mesh.vertices.front();
    for (const Face& f : mesh.faces)
        six_volumes +=
            (mesh.vertices[f[0]] - origin).dot((mesh.vertices[f[1]] - origin).cross(mesh.vertices[f[2]] - origin));
    return six_volumes / 6;
}

std::vector<int> first_coincident_vertex(const std::vector<Vec3>& vertices)
{
    std::vector<int> order(vertices.size());
    std::iota(order.begin(), order.end(), 0);
    tbb::parallel_sort(order.begin(), order.end(), [&](int a, int b) {
        for (int c = 0; c < 3; ++c)
            if (vertices[a][c] != vertices[b][c]) return vertices[a][c] < vertices[b][c];
        return a < b;
    });
    std::vector<int> first(vertices.size());
    for (std::size_t k = 0; k < order.size(); ++k)
        first[order[k]] = k > 0 && vertices[order[k]] == vertices[order[k - 1]] ? first[order[k - 1]] : order[k];
    return first;
}

}  // namespace selvage
