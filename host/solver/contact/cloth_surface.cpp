#include "host/solver/contact/cloth_surface.hpp"

#include <algorithm>
#include <numeric>

namespace selvage {
namespace {

// A panel is convex if it fills its convex hull.
bool is_convex(const Cloth& cloth, const ClothPanel& panel)
{
    double area = 0;
    std::vector<Vec2> points(cloth.panel_coordinates.begin() + panel.first_vertex,
                             cloth.panel_coordinates.begin() + panel.first_vertex + panel.vertex_count);
    for (int f = panel.first_face; f < panel.first_face + panel.face_count; ++f) {
        const Vec2 a = cloth.panel_coordinates[cloth.faces[f][1]] - cloth.panel_coordinates[cloth.faces[f][0]];
        const Vec2 b = cloth.panel_coordinates[cloth.faces[f][2]] - cloth.panel_coordinates[cloth.faces[f][0]];
        area += 0.5 * (a.x() * b.y() - a.y() * b.x());
    }
    std::sort(points.begin(), points.end(),
              [](const Vec2& a, const Vec2& b) { return std::pair(a.x(), a.y()) < std::pair(b.x(), b.y()); });
    std::vector<Vec2> hull;
    for (int side = 0; side < 2; ++side) {
        const std::size_t base = hull.size();
        for (const Vec2& p : points) {
            const auto turns_right = [&] {
                const Vec2 a = hull.back() - hull[hull.size() - 2], b = p - hull.back();
                return a.x() * b.y() - a.y() * b.x() <= 0;
            };
            while (hull.size() >= base + 2 && turns_right()) hull.pop_back();
            hull.push_back(p);
        }
        hull.pop_back();
        std::reverse(points.begin(), points.end());
    }
    double hull_area = 0;
    for (std::size_t k = 0; k < hull.size(); ++k) {
        const Vec2 &a = hull[k], &b = hull[(k + 1) % hull.size()];
        hull_area += 0.5 * (a.x() * b.y() - a.y() * b.x());
    }
    return area >= (1 - 1e-9) * hull_area;
}

}  // namespace

TreeSurface tree_surface(const Topology& topology, const Cloth& cloth)
{
    TreeSurface surface;
    surface.faces = topology.faces;
    for (const Face& f : cloth.faces)
        surface.rest.push_back(
            {cloth.panel_coordinates[f[0]], cloth.panel_coordinates[f[1]], cloth.panel_coordinates[f[2]]});
    for (const ClothPanel& panel : cloth.panels)
        surface.patches.push_back({panel.first_face, panel.face_count, true, is_convex(cloth, panel)});
    surface.group_of.resize(std::size_t(topology.particle_count));
    std::iota(surface.group_of.begin(), surface.group_of.end(), 0);
    // Vertices that are about to be sewn together must be free to meet.
    const Topology joined = make_topology(cloth, true);
    for (std::size_t v = 0; v < cloth.positions.size(); ++v)
        surface.group_of[topology.particle_of[v]] = joined.particle_of[v];
    return surface;
}

void add_bodies(TreeSurface& surface, const std::vector<Body>& bodies)
{
    for (const Body& body : bodies) {
        const int first = int(surface.body_corners.size());
        surface.patches.push_back({int(surface.faces.size()), int(body.mesh.faces.size()), false, false});
        for (const Face& f : body.mesh.faces)
            surface.faces.push_back({-1 - first - f[0], -1 - first - f[1], -1 - first - f[2]});
        surface.body_corners.insert(surface.body_corners.end(), body.mesh.vertices.begin(), body.mesh.vertices.end());
    }
    surface.rest.resize(surface.faces.size());
}

}  // namespace selvage
