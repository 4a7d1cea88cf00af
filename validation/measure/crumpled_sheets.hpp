#pragma once
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "validation/measure/small_cloth.hpp"

namespace selvage {

/// Adds a panel to a cloth, shifted by `at` in space [m].
inline void add_panel(Cloth& cloth, const Cloth& panel, const Vec3& at)
{
    const int first_vertex = int(cloth.positions.size()), first_face = int(cloth.faces.size());
    for (const Vec2& u : panel.panel_coordinates) cloth.panel_coordinates.push_back(u);
    for (const Vec3& x : panel.positions) cloth.positions.push_back(x + at);
    for (const Face& f : panel.faces)
        cloth.faces.push_back({f[0] + first_vertex, f[1] + first_vertex, f[2] + first_vertex});
    cloth.panels.push_back(panel.panels[0]);
    cloth.panels.back().first_vertex = first_vertex;
    cloth.panels.back().first_face = first_face;
}

/// A square panel with a slit of one cell's width from an edge to its middle, so that it is not convex.
inline Cloth slit_cloth(int side, double spacing)
{
    Cloth cloth = grid_cloth(side, side, spacing);
    std::erase_if(cloth.faces, [&](const Face& f) {
        Vec2 middle = Vec2::Zero();
        for (int v : f) middle += cloth.panel_coordinates[v] / (3 * spacing);
        return int(middle.x()) == side / 2 && middle.y() < side / 2;
    });
    cloth.panels[0].face_count = int(cloth.faces.size());
    return cloth;
}

/// A box with its lower corner at `low` and sides `size` [m], faces outward.
inline TriangleMesh box_mesh(const Vec3& low, const Vec3& size)
{
    TriangleMesh mesh;
    for (int k = 0; k < 8; ++k) mesh.vertices.push_back(low + size.cwiseProduct(Vec3(k & 1, k >> 1 & 1, k >> 2)));
    mesh.faces = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                  {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
    return mesh;
}

/// Returns random smooth displacements of the vertices of a cloth: a sum of waves over its rest coordinates.
/// @param size     approximate largest displacement [m]
/// @param longest  approximate longest wavelength [m]
inline std::vector<Vec3> random_waves(const Cloth& cloth, double size, double longest, std::mt19937& random)
{
    std::uniform_real_distribution<double> uniform(-1, 1);
    std::vector<Vec3> result(cloth.positions.size(), Vec3::Zero());
    for (std::size_t p = 0; p < cloth.panels.size(); ++p)
        for (int wave = 1; wave <= 6; ++wave) {
            const Vec3 height = size / wave * Vec3(uniform(random), uniform(random), uniform(random));
            const Vec2 across = 2 * std::numbers::pi * wave / longest * Vec2(uniform(random), uniform(random));
            const double phase = std::numbers::pi * uniform(random);
            const ClothPanel& panel = cloth.panels[p];
            for (int v = panel.first_vertex; v < panel.first_vertex + panel.vertex_count; ++v)
                result[v] += std::sin(across.dot(cloth.panel_coordinates[v]) + phase) * height;
        }
    return result;
}

/// Returns points as component planes: component c of point v is at [c * stride + v].
inline std::vector<real> as_planes(const std::vector<Vec3>& points, int stride)
{
    std::vector<real> planes(3 * std::size_t(stride));
    for (std::size_t v = 0; v < points.size(); ++v)
        for (int c = 0; c < 3; ++c) planes[c * std::size_t(stride) + v] = points[v][c];
    return planes;
}

/// Returns the points of component planes.
inline std::vector<Vec3> as_points(const std::vector<real>& planes, int stride, int count)
{
    std::vector<Vec3> points(static_cast<std::size_t>(count));
    for (int v = 0; v < count; ++v) points[v] = {planes[v], planes[stride + v], planes[2 * stride + v]};
    return points;
}

}  // namespace selvage
