#include "host/mesh/sheet_families.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "host/mesh/panel_mesh.hpp"
#include "host/mesh/renumber.hpp"

namespace selvage {
namespace {

// Chosen by hand; not measured.
constexpr double jitter = 0.27;       // of irregular meshes, over the grid spacing [1]
constexpr double rim_distance = 0.6;  // least, of a disc's inner points, over the edge length [1]

// Returns a number in [-1, 1] that depends on the index only (Steele, Lea and Flood 2014, SplitMix64).
double scatter(std::uint64_t index)
{
    std::uint64_t bits = (index + 1) * 0x9e3779b97f4a7c15ull;
    bits = (bits ^ (bits >> 30)) * 0xbf58476d1ce4e5b9ull;
    bits = (bits ^ (bits >> 27)) * 0x94d049bb133111ebull;
    return double((bits ^ (bits >> 31)) >> 11) / 4503599627370496.0 - 1;
}

Vec2 scattered(int vertex)
{
    return jitter * Vec2(scatter(2 * std::uint64_t(vertex)), scatter(2 * std::uint64_t(vertex) + 1));
}

// Returns points row by row, from -warp to +warp and from -weft to +weft.
SheetMesh grid_points(double width, double height, int columns, int rows)
{
    SheetMesh mesh;
    for (int j = 0; j < rows; ++j)
        for (int i = 0; i < columns; ++i)
            mesh.points.push_back({width * i / (columns - 1) - 0.5 * width, height * j / (rows - 1) - 0.5 * height});
    return mesh;
}

// Triangulates a grid whose interior points are jittered. triangulate_points() needs the boundary points first.
void irregular_faces(SheetMesh& mesh, int columns, int rows, const Vec2& spacing)
{
    std::vector<int> order;
    for (int i = 0; i < columns; ++i) order.push_back(i);
    for (int j = 1; j < rows; ++j) order.push_back(j * columns + columns - 1);
    for (int i = columns - 2; i >= 0; --i) order.push_back((rows - 1) * columns + i);
    for (int j = rows - 2; j > 0; --j) order.push_back(j * columns);
    const int rim = int(order.size());
    for (int j = 1; j + 1 < rows; ++j)
        for (int i = 1; i + 1 < columns; ++i) {
            const int vertex = j * columns + i;
            mesh.points[vertex] += spacing.cwiseProduct(scattered(vertex));
            order.push_back(vertex);
        }
    std::vector<Vec2> ordered;
    ordered.reserve(order.size());
    for (const int vertex : order) ordered.push_back(mesh.points[vertex]);
    mesh.faces = triangulate_points(ordered, rim);
    for (Face& face : mesh.faces) {
        for (int& vertex : face) vertex = order[vertex];
        std::rotate(face.begin(), std::min_element(face.begin(), face.end()), face.end());
    }
    std::sort(mesh.faces.begin(), mesh.faces.end());
}

bool falling_diagonal(MeshFamily family, int i, int j)
{
    return (family == MeshFamily::alternating && (i + j) % 2 == 1) || (family == MeshFamily::rows && j % 2 == 1);
}

void diagonal_faces(SheetMesh& mesh, MeshFamily family, int columns, int rows)
{
    mesh.faces.reserve(2 * std::size_t(columns - 1) * (rows - 1));
    for (int j = 0; j + 1 < rows; ++j)
        for (int i = 0; i + 1 < columns; ++i) {
            const int a = j * columns + i, b = a + 1, c = b + columns, d = a + columns;
            if (falling_diagonal(family, i, j)) {
                mesh.faces.push_back({a, b, d});
                mesh.faces.push_back({b, c, d});
            } else {
                mesh.faces.push_back({a, b, c});
                mesh.faces.push_back({a, c, d});
            }
        }
}

// Each row of grid points is followed by the midpoints of its squares, so that neighbours are close in memory.
SheetMesh cross_mesh(double width, double height, int columns, int rows)
{
    const Vec2 spacing(width / (columns - 1), height / (rows - 1));
    SheetMesh mesh;
    for (int j = 0; j < rows; ++j) {
        for (int i = 0; i < columns; ++i)
            mesh.points.push_back({i * spacing.x() - 0.5 * width, j * spacing.y() - 0.5 * height});
        for (int i = 0; i + 1 < columns && j + 1 < rows; ++i)
            mesh.points.push_back({(i + 0.5) * spacing.x() - 0.5 * width, (j + 0.5) * spacing.y() - 0.5 * height});
    }
    for (int j = 0; j + 1 < rows; ++j)
        for (int i = 0; i + 1 < columns; ++i) {
            const int a = j * (2 * columns - 1) + i, b = a + 1, d = a + 2 * columns - 1, c = d + 1,
                      middle = a + columns;
            for (const auto& [from, to] : {std::pair{a, b}, {b, c}, {c, d}, {d, a}})
                mesh.faces.push_back({from, to, middle});
        }
    return mesh;
}

SheetMesh equilateral_mesh(double width, double height, int columns)
{
    const double spacing = width / (columns - 1);
    const int rows = std::max(1, int(std::lround(height / (spacing * 0.5 * std::numbers::sqrt3)))) + 1;
    SheetMesh mesh;
    std::vector<int> begin;
    for (int j = 0; j < rows; ++j) {
        begin.push_back(int(mesh.points.size()));
        const double y = height * j / (rows - 1) - 0.5 * height;
        for (int i = 0; i < columns + j % 2; ++i) {
            const double x = j % 2 == 0 ? i * spacing : std::clamp((i - 0.5) * spacing, 0.0, width);
            mesh.points.push_back({x - 0.5 * width, y});
        }
    }
    for (int j = 0; j + 1 < rows; ++j) {
        const bool odd_above = j % 2 == 0;
        const int even = begin[odd_above ? j : j + 1], odd = begin[odd_above ? j + 1 : j];
        const auto add = [&](int a, int b, int c) { mesh.faces.push_back(odd_above ? Face{a, b, c} : Face{b, a, c}); };
        for (int i = 0; i < columns; ++i) {
            add(odd + i + 1, odd + i, even + i);
            if (i + 1 < columns) add(even + i, even + i + 1, odd + i + 1);
        }
    }
    return mesh;
}

// Returns the points of a lattice inside the disc, row by row. In `equilateral` every second row is shifted by
// half a spacing.
std::vector<Vec2> disc_lattice(MeshFamily family, double radius, double spacing)
{
    const bool triangles = family == MeshFamily::equilateral;
    const double rise = triangles ? spacing * 0.5 * std::numbers::sqrt3 : spacing;
    const int half = int(radius / rise) + 2;
    std::vector<Vec2> points;
    for (int j = -half; j <= half; ++j)
        for (int i = -half; i <= half; ++i) {
            Vec2 point(spacing * (i + (triangles && j % 2 != 0 ? 0.5 : 0.0)), rise * j);
            if (family == MeshFamily::irregular) point += spacing * scattered((j + half) * (2 * half + 1) + i + half);
            if (point.norm() < radius - rim_distance * spacing) points.push_back(point);
        }
    return points;
}

}  // namespace

std::span<const MeshFamily> rectangle_families()
{
    static constexpr MeshFamily families[] = {MeshFamily::alternating, MeshFamily::same_diagonal,
                                              MeshFamily::rows,        MeshFamily::cross,
                                              MeshFamily::equilateral, MeshFamily::irregular};
    return families;
}

std::span<const MeshFamily> disc_families()
{
    static constexpr MeshFamily families[] = {MeshFamily::panel, MeshFamily::equilateral, MeshFamily::square,
                                              MeshFamily::irregular};
    return families;
}

SheetMesh rectangle_mesh(MeshFamily family, double width, double height, int columns)
{
    if (family == MeshFamily::equilateral) return equilateral_mesh(width, height, columns);
    const int rows = std::max(2, int(std::lround((columns - 1) * height / width)) + 1);
    if (family == MeshFamily::cross) return cross_mesh(width, height, columns, rows);
    SheetMesh mesh = grid_points(width, height, columns, rows);
    if (family == MeshFamily::irregular)
        irregular_faces(mesh, columns, rows, Vec2(width / (columns - 1), height / (rows - 1)));
    else
        diagonal_faces(mesh, family, columns, rows);
    return mesh;
}

SheetMesh disc_mesh(MeshFamily family, double radius, int across)
{
    const double spacing = 2 * radius / (across - 1);
    const int rim = std::max(6, int(std::lround(2 * std::numbers::pi * radius / spacing)));
    std::vector<Vec2> points;
    for (int i = 0; i < rim; ++i) {
        const double angle = 2 * std::numbers::pi * i / rim;
        points.push_back(radius * Vec2(std::cos(angle), std::sin(angle)));
    }
    SheetMesh mesh;
    if (family == MeshFamily::panel) {
        PanelMesh panel = mesh_panel(points, spacing);
        mesh = {std::move(panel.vertices), std::move(panel.faces)};
    } else {
        const std::vector<Vec2> inner = disc_lattice(family, radius, spacing);
        points.insert(points.end(), inner.begin(), inner.end());
        mesh = {points, triangulate_points(points, rim)};
    }
    renumber_for_locality(mesh.points, mesh.faces);
    return mesh;
}

}  // namespace selvage
