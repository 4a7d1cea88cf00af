#include "host/mesh/mesh_quality.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace selvage {
namespace {

using Triangle = Triangulation::Triangle;

// How repair() improves triangles. Chosen by hand, not measured one by one; the unit test of the angles of panel meshes
// checks what they achieve together.
struct RepairTuning {
    static constexpr int max_passes = 10;            // over all triangles
    static constexpr int max_stalled_passes = 2;     // passes in a row that leave no fewer bad triangles
    static constexpr double insert_sine = 0.37;      // sine of the angle (22 degrees) below which a vertex is inserted
    static constexpr double min_improvement = 0.02;  // of the smallest sine, for a removal or insertion to be kept
    static constexpr int relax_sweeps = 3;           // over the vertices around a bad triangle
    static constexpr int max_trials = 24;            // of the pattern search for one vertex
    static constexpr double first_step = 0.25;       // of the pattern search, of the wanted edge length
    static constexpr double last_step = 0.02;        // of the pattern search, of the wanted edge length
};
constexpr double min_sine_after_smoothing = 0.02;  // a triangle below counts as inverted; chosen by hand, not measured

Vec2 as_vector(const GridPoint& point) { return Vec2(point.x, point.y); }

GridPoint as_grid(const Vec2& point) { return {int(std::lround(point.x())), int(std::lround(point.y()))}; }

// Returns the sine of the smallest angle: twice the area over the product of the two longer sides.
double smallest_sine(const GridPoint& a, const GridPoint& b, const GridPoint& c)
{
    const Vec2 u = as_vector(b) - as_vector(a), v = as_vector(c) - as_vector(a);
    const double sides[] = {u.squaredNorm(), v.squaredNorm(), (u - v).squaredNorm()};
    const double longer = sides[0] * sides[1] * sides[2] / std::min({sides[0], sides[1], sides[2]});
    return longer > 0 ? double(doubled_area(a, b, c)) / std::sqrt(longer) : 0;
}

double smallest_sine(const Triangulation& mesh, int triangle)
{
    const std::array<int, 3>& corner = mesh.triangles()[triangle].vertex;
    return smallest_sine(mesh.points()[corner[0]], mesh.points()[corner[1]], mesh.points()[corner[2]]);
}

// Returns the smallest sine of some triangles, without free slots.
double worst_sine(const Triangulation& mesh, const std::vector<int>& triangles)
{
    double worst = 1;
    for (const int triangle : triangles)
        if (mesh.triangles()[triangle].vertex[0] >= 0) worst = std::min(worst, smallest_sine(mesh, triangle));
    return worst;
}

// Returns the circumcentre, or the centroid where the circumcentre lies beyond the boundary.
Vec2 smoothing_centre(const Triangle& triangle, const std::array<Vec2, 3>& corner, double doubled)
{
    for (int i = 0; i < 3; ++i) {
        const Vec2 u = corner[(i + 1) % 3] - corner[i], v = corner[(i + 2) % 3] - corner[i];
        if (triangle.neighbour[i] < 0 && u.dot(v) < 0) return (corner[0] + corner[1] + corner[2]) / 3;
    }
    const Vec2 u = corner[1] - corner[0], v = corner[2] - corner[0];
    const Vec2 turned = (u * v.squaredNorm() - v * u.squaredNorm()) / (2 * doubled);
    return corner[0] + Vec2(-turned.y(), turned.x());
}

// Returns the smoothed positions of the vertices: the means of the triangle centres around them, weighted with
// area and density.
std::vector<Vec2> smoothed_places(const PanelDraft& draft)
{
    const Triangulation& mesh = draft.triangulation;
    const std::size_t count = mesh.points().size();
    std::vector<double> size(count), weight(count, 0.0);
    std::vector<Vec2> sum(count, Vec2::Zero());
    for (std::size_t vertex = 0; vertex < count; ++vertex)
        size[vertex] = draft.size.at(as_vector(mesh.points()[vertex]));
    for (const Triangle& triangle : mesh.triangles()) {
        if (triangle.vertex[0] < 0) continue;
        std::array<Vec2, 3> corner;
        double length = 0;
        for (int i = 0; i < 3; ++i) {
            corner[i] = as_vector(mesh.points()[triangle.vertex[i]]);
            length += size[triangle.vertex[i]] / 3;
        }
        const Vec2 u = corner[1] - corner[0], v = corner[2] - corner[0];
        const double doubled = u.x() * v.y() - u.y() * v.x();
        const double share = doubled / (length * length * length * length);
        const Vec2 centre = smoothing_centre(triangle, corner, doubled);
        for (const int vertex : triangle.vertex) {
            sum[vertex] += share * centre;
            weight[vertex] += share;
        }
    }
    for (std::size_t vertex = 0; vertex < count; ++vertex)
        if (weight[vertex] > 0) sum[vertex] /= weight[vertex];
    return sum;
}

// Undoes vertex moves until no triangle is inverted or nearly flat.
void undo_inverting_moves(Triangulation& mesh, const std::vector<GridPoint>& before)
{
    for (bool changed = true; changed;) {
        changed = false;
        for (const Triangle& triangle : mesh.triangles()) {
            if (triangle.vertex[0] < 0) continue;
            const auto [a, b, c] = triangle.vertex;
            if (smallest_sine(mesh.points()[a], mesh.points()[b], mesh.points()[c]) > min_sine_after_smoothing)
                continue;
            for (const int vertex : triangle.vertex)
                if (!(mesh.points()[vertex] == before[vertex])) {
                    mesh.move(vertex, before[vertex]);
                    changed = true;
                }
        }
    }
}

// Pattern search for the position of a vertex that maximises the smallest angle around it; returns whether
// the vertex moved.
bool improve_vertex(PanelDraft& draft, int vertex, std::vector<int>& ring)
{
    Triangulation& mesh = draft.triangulation;
    mesh.star(vertex, ring);
    const Vec2 start = as_vector(mesh.points()[vertex]);
    Vec2 best = start;
    double quality = worst_sine(mesh, ring);
    const double size = draft.size.at(start);
    double step = RepairTuning::first_step * size;
    for (int trial = 0; trial < RepairTuning::max_trials && step > RepairTuning::last_step * size; ++trial) {
        const Vec2 middle = best;
        for (int direction = 0; direction < 8; ++direction) {
            const double angle = direction * std::numbers::pi / 4;
            const Vec2 place = middle + step * Vec2(std::cos(angle), std::sin(angle));
            mesh.move(vertex, as_grid(place));
            const double other = worst_sine(mesh, ring);
            if (other > quality) {
                quality = other;
                best = place;
            }
        }
        if (best == middle) step /= 2;
    }
    mesh.move(vertex, as_grid(best));
    if (best == start) return false;
    mesh.restore(ring);
    return true;
}

class Repair {
public:
    Repair(PanelDraft& draft, double sine) : draft_(draft), mesh_(draft.triangulation), sine_(sine) {}

    // Returns the number of bad triangles found.
    int pass()
    {
        int bad = 0;
        const int count = int(mesh_.triangles().size());  // triangles created in this pass wait for the next one
        for (int triangle = 0; triangle < count; ++triangle) {
            if (good(triangle)) continue;
            ++bad;
            relax_around({triangle});
            if (good(triangle) || thin_out(triangle)) continue;
            if (smallest_sine(mesh_, triangle) < RepairTuning::insert_sine) fill_in(triangle);
        }
        return bad;
    }

private:
    bool good(int triangle) const
    {
        return mesh_.triangles()[triangle].vertex[0] < 0 || smallest_sine(mesh_, triangle) >= sine_;
    }

    bool interior(int vertex) const { return vertex >= draft_.boundary_count; }

    // Improves, one after the other, the positions of the vertices of the given triangles and of their neighbours.
    void relax_around(const std::vector<int>& triangles)
    {
        std::vector<int> vertices;
        for (const int triangle : triangles)
            for (const int corner : mesh_.triangles()[triangle].vertex) {
                if (corner < 0) continue;
                mesh_.star(corner, ring_);
                for (const int near : ring_)
                    for (const int vertex : mesh_.triangles()[near].vertex)
                        if (interior(vertex)) vertices.push_back(vertex);
            }
        std::sort(vertices.begin(), vertices.end());
        vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
        for (int sweep = 0; sweep < RepairTuning::relax_sweeps; ++sweep)
            for (const int vertex : vertices) {
                mesh_.star(vertex, ring_);
                if (worst_sine(mesh_, ring_) < sine_) improve_vertex(draft_, vertex, ring_);
            }
    }

    // Removes one corner if the triangles around it improve; returns whether one was removed.
    bool thin_out(int triangle)
    {
        const std::array<int, 3> corner = mesh_.triangles()[triangle].vertex;
        for (const int vertex : corner) {
            if (!interior(vertex)) continue;
            const GridPoint place = mesh_.points()[vertex];
            mesh_.star(vertex, ring_);
            const double before = worst_sine(mesh_, ring_);
            if (!mesh_.remove(vertex)) continue;
            const std::vector<int> changed = mesh_.touched();
            if (improved_after_moving(changed, before)) return true;
            const int inside = mesh_.locate(place, alive_one(changed));
            if (inside >= 0) mesh_.insert(place, inside);
        }
        return false;
    }

    // Inserts a vertex near the triangle if the triangles around it improve.
    void fill_in(int triangle)
    {
        const std::array<int, 3> corner = mesh_.triangles()[triangle].vertex;
        const double before = smallest_sine(mesh_, triangle);
        const auto point = [&](int i) { return as_vector(mesh_.points()[corner[i]]); };
        const Vec2 places[] = {(point(0) + point(1)) / 2, (point(1) + point(2)) / 2, (point(2) + point(0)) / 2,
                               (point(0) + point(1) + point(2)) / 3};
        int start = triangle;
        for (const Vec2& place : places) {
            const int inside = mesh_.locate(as_grid(place), start);
            const int vertex = inside < 0 ? -1 : mesh_.insert(as_grid(place), inside);
            if (vertex < 0) continue;
            improve_vertex(draft_, vertex, ring_);
            mesh_.star(vertex, ring_);
            if (improved_after_moving(std::vector<int>(ring_), before)) return;
            mesh_.star(vertex, ring_);
            const std::vector<int> around = ring_;
            if (!mesh_.remove(vertex)) return;
            start = alive_one(around);
        }
    }

    int alive_one(const std::vector<int>& triangles) const
    {
        for (const int triangle : triangles)
            if (mesh_.triangles()[triangle].vertex[0] >= 0) return triangle;
        return 0;
    }

    // Returns whether the triangles are better than `before`, if necessary after moving their corners.
    bool improved_after_moving(const std::vector<int>& triangles, double before)
    {
        const double wanted = std::min(sine_, before + RepairTuning::min_improvement);
        if (worst_sine(mesh_, triangles) >= wanted) return true;
        std::vector<int> corners;
        for (const int triangle : triangles)
            for (const int vertex : mesh_.triangles()[triangle].vertex)
                if (vertex >= 0 && interior(vertex)) corners.push_back(vertex);
        relax_around(triangles);
        double worst = worst_sine(mesh_, triangles);
        for (const int vertex : corners) {
            mesh_.star(vertex, ring_);
            worst = std::min(worst, worst_sine(mesh_, ring_));
        }
        return worst >= wanted;
    }

    PanelDraft& draft_;
    Triangulation& mesh_;
    double sine_;
    std::vector<int> ring_;
};

}  // namespace

double smallest_angle(const GridPoint& a, const GridPoint& b, const GridPoint& c)
{
    return std::asin(std::clamp(smallest_sine(a, b, c), -1.0, 1.0)) * 180 / std::numbers::pi;
}

void smooth(PanelDraft& draft, int rounds)
{
    Triangulation& mesh = draft.triangulation;
    for (int round = 0; round < rounds; ++round) {
        const std::vector<Vec2> places = smoothed_places(draft);
        const std::vector<GridPoint> before = mesh.points();
        for (int vertex = draft.boundary_count; vertex < int(places.size()); ++vertex)
            if (mesh.alive(vertex)) mesh.move(vertex, as_grid(places[vertex]));
        undo_inverting_moves(mesh, before);
        mesh.restore();
    }
}

void repair(PanelDraft& draft, double degrees)
{
    Repair work(draft, std::sin(degrees * std::numbers::pi / 180));
    int fewest = std::numeric_limits<int>::max(), stalled = 0;
    for (int pass = 0; pass < RepairTuning::max_passes && stalled < RepairTuning::max_stalled_passes; ++pass) {
        const int bad = work.pass();
        if (bad == 0) return;
        stalled = bad < fewest ? 0 : stalled + 1;
        fewest = std::min(fewest, bad);
    }
}

}  // namespace selvage
