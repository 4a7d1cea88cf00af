// The exact Delaunay triangulation under the panel meshes.

#include <cmath>
#include <numbers>

#include "host/mesh/delaunay.hpp"
#include "host/mesh/panel_mesh.hpp"
#include "validation/unit/catch.hpp"

using namespace selvage;

namespace {

double turn(const Vec2& a, const Vec2& b, const Vec2& c)
{
    return (b - a).x() * (c - a).y() - (b - a).y() * (c - a).x();
}

// A reproducible number in [0, 1).
double random_number(unsigned& state)
{
    state = state * 1664525u + 1013904223u;
    return (state >> 8) / 16777216.0;
}

// Returns a ring of points around the origin. With a disorder above 1 neighbours can be in the wrong order.
std::vector<Vec2> ragged_ring(int count, double disorder, unsigned& state)
{
    std::vector<Vec2> ring;
    for (int i = 0; i < count; ++i) {
        const double angle = 2 * std::numbers::pi * (i + disorder * random_number(state)) / count;
        const double radius = 0.3 + 0.7 * random_number(state);
        ring.push_back(radius * Vec2(std::cos(angle), std::sin(angle)));
    }
    return ring;
}

bool crosses_by_pairs(const std::vector<Vec2>& polygon)
{
    const int count = int(polygon.size());
    for (int i = 0; i < count; ++i)
        for (int j = i + 2; j < count - (i == 0 ? 1 : 0); ++j) {
            const Vec2 &a = polygon[i], &b = polygon[i + 1], &c = polygon[j], &d = polygon[(j + 1) % count];
            if (turn(a, b, c) * turn(a, b, d) < 0 && turn(c, d, a) * turn(c, d, b) < 0) return true;
        }
    return false;
}

}  // namespace

TEST_CASE("crossing polygon sides are found exactly where a test of all pairs finds some")
{
    unsigned state = 3;
    int crossing = 0;
    for (int trial = 0; trial < 500; ++trial) {
        const std::vector<Vec2> polygon = ragged_ring(4 + trial % 8, 1.8, state);
        const bool expected = crosses_by_pairs(polygon);
        crossing += expected;
        CHECK(crossing_sides(polygon).has_value() == expected);
    }
    CHECK((crossing > 50 && crossing < 450));
}

TEST_CASE("touching polygon sides count as crossing")
{
    CHECK(crossing_sides({{0, 0}, {2, 0}, {2, 2}, {1, 0}, {0, 2}}));          // a corner on a side
    CHECK(crossing_sides({{0, 0}, {2, 0}, {1, 1}, {2, 2}, {0, 2}, {1, 1}}));  // two corners in one place
    CHECK(crossing_sides({{0, 0}, {3, 0}, {1, 0}, {1, 1}}));                  // a side that doubles back
    CHECK_FALSE(crossing_sides({{0, 0}, {1, 0}, {2, 0}, {2, 2}, {0, 2}}));    // a straight corner is fine
}

TEST_CASE("ragged polygons with uneven sides are filled without gaps or overlaps")
{
    unsigned state = 11;
    for (int trial = 0; trial < 12; ++trial) {
        const std::vector<Vec2> ring = ragged_ring(5 + trial, 0.7, state);
        std::vector<Vec2> polygon;
        for (std::size_t i = 0; i < ring.size(); ++i) {
            const int parts = 1 + int(6 * random_number(state));
            for (int j = 0; j < parts; ++j)
                polygon.push_back(ring[i] + double(j) / parts * (ring[(i + 1) % ring.size()] - ring[i]));
        }
        const PanelMesh mesh = mesh_panel(polygon, 0.15);
        double outline = 0, filled = 0;
        for (std::size_t i = 0; i < polygon.size(); ++i)
            outline += turn(Vec2::Zero(), polygon[i], polygon[(i + 1) % polygon.size()]);
        for (const Face& face : mesh.faces) {
            const double area = turn(mesh.vertices[face[0]], mesh.vertices[face[1]], mesh.vertices[face[2]]);
            CHECK(area > 0);
            filled += area;
        }
        CHECK(filled == Approx(outline).epsilon(1e-9));
        CHECK(mesh.faces.size() == 2 * mesh.vertices.size() - 2 - polygon.size());
    }
}

TEST_CASE("the circle test is exact where doubles are not")
{
    const int r = 1 << 26;
    const GridPoint a{r, 0}, b{0, r}, c{-r, 0};
    CHECK_FALSE(in_circle(a, b, c, {0, -r}));
    CHECK(in_circle(a, b, c, {0, -r + 1}));
    CHECK_FALSE(in_circle(a, b, c, {0, -r - 1}));
    CHECK_FALSE(in_circle(a, b, c, {1, -r}));
}

TEST_CASE("removing inserted points leaves a Delaunay triangulation of the others")
{
    std::vector<GridPoint> points{{-50000, -50000}, {50000, -50000}, {50000, 50000}, {-50000, 50000}};
    unsigned state = 7;
    for (int i = 0; i < 300; ++i) {
        state = state * 1664525u + 1013904223u;
        const int x = int(state >> 16) % 99000 - 49500;
        state = state * 1664525u + 1013904223u;
        points.push_back({x, int(state >> 16) % 99000 - 49500});
    }
    Triangulation mesh(points);
    REQUIRE_FALSE(mesh.cut_out(4));
    for (int vertex = 4; vertex < 304; vertex += 2) REQUIRE(mesh.remove(vertex));
    long long area = 0;
    int count = 0;
    for (const Triangulation::Triangle& triangle : mesh.triangles()) {
        if (triangle.vertex[0] < 0) continue;
        const auto [a, b, c] = triangle.vertex;
        area += doubled_area(points[a], points[b], points[c]);
        ++count;
        for (int vertex = 0; vertex < 304; ++vertex)
            if (mesh.alive(vertex)) REQUIRE_FALSE(in_circle(points[a], points[b], points[c], points[vertex]));
    }
    CHECK(area == 2LL * 100000 * 100000);
    CHECK(count == 2 * 154 - 2 - 4);
}
