#include "host/mesh/panel_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <string>

#include "host/mesh/mesh_quality.hpp"

namespace selvage {
namespace {

// Where refine() puts new vertices. Chosen by hand; the unit test of the angles and edges of panel meshes checks what
// the values achieve together.
struct RefinementTuning {
    // Circumradius over wanted edge length above which a triangle is split at its circumcentre [1]. Chosen so that the
    // mean edge has the wanted length.
    static constexpr double max_circumradius = 0.765;
    // Distances that a new vertex keeps and moves that it makes, over the largest circumradius [1].
    static constexpr double vertex_distance = 0.75;   // to other vertices
    static constexpr double boundary_distance = 0.4;  // to the boundary
    static constexpr double jitter = 0.15;            // random displacement, which breaks the symmetry of panels
    static constexpr double min_height = 0.25;        // distance to a boundary side over the length of that side [1]
};

// How often a mesh is improved. Chosen by hand, not measured one by one; see RefinementTuning.
struct AttemptTuning {
    static constexpr int smoothing_rounds = 8;
    static constexpr double good_angle = 30;  // triangles below it are repaired [degrees]
    // A mesh with a triangle below this angle [degrees] is made again with other random positions, if it is small.
    static constexpr double poor_angle = 22;
    static constexpr int max_attempts = 6;
    static constexpr int max_retried = 20000;  // size of a small mesh [vertices]
};

Vec2 as_vector(const GridPoint& point) { return Vec2(point.x, point.y); }

GridPoint as_grid(const Vec2& point) { return {int(std::lround(point.x())), int(std::lround(point.y()))}; }

Triangulation cut_triangulation(const std::vector<Vec2>& points, const GridMap& map, int polygon_size)
{
    std::vector<GridPoint> grid;
    grid.reserve(points.size());
    for (const Vec2& point : points) grid.push_back(map.to_grid(point));
    Triangulation triangulation(std::move(grid));
    if (const auto crossing = triangulation.cut_out(polygon_size))
        throw std::invalid_argument("polygon sides " + std::to_string((*crossing)[0]) + " and " +
                                    std::to_string((*crossing)[1]) + " cross or touch");
    return triangulation;
}

// Returns numbers in [-1, 1] that depend on the two integers only (Steele, Lea and Flood 2014, SplitMix64).
Vec2 scatter(std::uint64_t a, std::uint64_t b)
{
    std::uint64_t bits = a * 0x9e3779b97f4a7c15ull + b;
    bits = (bits ^ (bits >> 30)) * 0xbf58476d1ce4e5b9ull;
    bits = (bits ^ (bits >> 27)) * 0x94d049bb133111ebull;
    bits ^= bits >> 31;
    return Vec2(double(bits >> 32), double(bits & 0xffffffffu)) / 2147483647.5 - Vec2::Ones();
}

bool near_side(const Vec2& point, const Vec2& a, const Vec2& b, double radius)
{
    const double along = std::clamp((point - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
    const double distance = (point - a - along * (b - a)).norm();
    return distance < RefinementTuning::boundary_distance * radius ||
           (along > 0 && along < 1 && distance < RefinementTuning::min_height * (b - a).norm());
}

// Returns whether a new vertex in this triangle would be too close to vertices or boundary sides around it.
bool crowded(const Triangulation& triangulation, int triangle, const Vec2& place, double radius)
{
    const auto too_near = [&](int vertex) {
        return (as_vector(triangulation.points()[vertex]) - place).norm() < RefinementTuning::vertex_distance * radius;
    };
    const Triangulation::Triangle& t = triangulation.triangles()[triangle];
    for (int i = 0; i < 3; ++i) {
        if (too_near(t.vertex[i])) return true;
        const Vec2 a = as_vector(triangulation.points()[t.vertex[(i + 1) % 3]]);
        const Vec2 b = as_vector(triangulation.points()[t.vertex[(i + 2) % 3]]);
        if (t.neighbour[i] < 0) {
            if (near_side(place, a, b, radius)) return true;
            continue;
        }
        const Triangulation::Triangle& beyond = triangulation.triangles()[t.neighbour[i]];
        for (int j = 0; j < 3; ++j) {
            if (too_near(beyond.vertex[j])) return true;
            if (beyond.neighbour[j] >= 0) continue;
            const Vec2 c = as_vector(triangulation.points()[beyond.vertex[(j + 1) % 3]]);
            const Vec2 d = as_vector(triangulation.points()[beyond.vertex[(j + 2) % 3]]);
            if (near_side(place, c, d, radius)) return true;
        }
    }
    return false;
}

// Inserts vertices near the circumcentres of triangles that are too large (Chew 1989). The result is a set of points at
// random positions, which depend on `seed`, with bounds on the distance between neighbours.
void refine(PanelDraft& draft, int seed)
{
    Triangulation& mesh = draft.triangulation;
    std::vector<int> waiting;
    for (int triangle = 0; triangle < int(mesh.triangles().size()); ++triangle) waiting.push_back(triangle);
    while (!waiting.empty()) {
        const int triangle = waiting.back();
        waiting.pop_back();
        const std::array<int, 3> corner = mesh.triangles()[triangle].vertex;
        const Vec2 a = as_vector(mesh.points()[corner[0]]);
        const Vec2 u = as_vector(mesh.points()[corner[1]]) - a, v = as_vector(mesh.points()[corner[2]]) - a;
        const double doubled = u.x() * v.y() - u.y() * v.x();
        if (doubled <= 0) continue;
        const Vec2 middle = (u * v.squaredNorm() - v * u.squaredNorm()) / (2 * doubled);
        const Vec2 centre(a.x() - middle.y(), a.y() + middle.x());
        if (centre.cwiseAbs().maxCoeff() > (1 << 27)) continue;
        const double radius = RefinementTuning::max_circumradius * draft.size.at(centre);
        if (middle.norm() <= radius) continue;
        const std::uint64_t salt = std::uint64_t(corner[0]) + (std::uint64_t(seed) << 32);
        const Vec2 place = centre + RefinementTuning::jitter * radius * scatter(salt, mesh.points().size());
        const int inside = mesh.locate(as_grid(place), triangle);
        if (inside < 0 || crowded(mesh, inside, place, radius)) continue;
        if (mesh.insert(as_grid(place), inside) < 0) continue;
        waiting.insert(waiting.end(), mesh.touched().begin(), mesh.touched().end());
    }
}

std::vector<Vec2> in_grid_steps(const std::vector<Vec2>& polygon, const GridMap& map)
{
    std::vector<Vec2> steps;
    steps.reserve(polygon.size());
    for (const Vec2& point : polygon) steps.push_back(as_vector(map.to_grid(point)));
    return steps;
}

// Returns the smallest angle [degrees] of all triangles but those with two sides on the outline, which
// determines their angles.
double worst_angle(const Triangulation& mesh)
{
    double worst = 60;
    for (const Triangulation::Triangle& triangle : mesh.triangles()) {
        if (triangle.vertex[0] < 0 || std::count(triangle.neighbour.begin(), triangle.neighbour.end(), -1) > 1)
            continue;
        const auto [a, b, c] = triangle.vertex;
        worst = std::min(worst, smallest_angle(mesh.points()[a], mesh.points()[b], mesh.points()[c]));
    }
    return worst;
}

// Meshes the empty panel. If angles stay poor, returns the best of several attempts.
PanelDraft best_mesh(const PanelDraft& empty)
{
    PanelDraft best = empty;
    double best_angle = -1;
    for (int attempt = 0; attempt < AttemptTuning::max_attempts; ++attempt) {
        PanelDraft draft = empty;
        refine(draft, attempt);
        smooth(draft, AttemptTuning::smoothing_rounds);
        repair(draft, AttemptTuning::good_angle);
        const double angle = worst_angle(draft.triangulation);
        const bool finished =
            angle >= AttemptTuning::poor_angle || int(draft.triangulation.points().size()) > AttemptTuning::max_retried;
        if (angle > best_angle) {
            best_angle = angle;
            best = std::move(draft);
        }
        if (finished) break;
    }
    return best;
}

}  // namespace

PanelMesh mesh_panel(const std::vector<Vec2>& polygon, double edge_length)
{
    const GridMap map(polygon);
    const PanelDraft draft =
        best_mesh({cut_triangulation(polygon, map, int(polygon.size())),
                   SizeField(in_grid_steps(polygon, map), edge_length / map.step()), int(polygon.size())});

    PanelMesh mesh;
    mesh.vertices = polygon;
    const Triangulation& result = draft.triangulation;
    std::vector<int> renumbered(result.points().size(), -1);
    for (int vertex = 0; vertex < int(result.points().size()); ++vertex) {
        if (!result.alive(vertex)) continue;
        renumbered[vertex] = vertex < draft.boundary_count ? vertex : int(mesh.vertices.size());
        if (vertex >= draft.boundary_count) mesh.vertices.push_back(map.to_plane(result.points()[vertex]));
    }
    for (const Triangulation::Triangle& triangle : result.triangles())
        if (triangle.vertex[0] >= 0)
            mesh.faces.push_back(
                {renumbered[triangle.vertex[0]], renumbered[triangle.vertex[1]], renumbered[triangle.vertex[2]]});
    return mesh;
}

std::vector<Face> triangulate_points(const std::vector<Vec2>& points, int polygon_size)
{
    const Triangulation triangulation = cut_triangulation(points, GridMap(points), polygon_size);
    std::vector<Face> faces;
    faces.reserve(triangulation.triangles().size());
    for (const Triangulation::Triangle& triangle : triangulation.triangles()) faces.push_back(triangle.vertex);
    return faces;
}

}  // namespace selvage
