#include <random>

#include "host/mesh/body_tessellation.hpp"
#include "host/mesh/exact_orientation.hpp"
#include "host/mesh/self_intersections.hpp"
#include "host/mesh/triangle_intersection.hpp"
#include "validation/unit/catch.hpp"

using namespace selvage;

namespace {

__extension__ typedef __int128 Whole;

// Returns the sign of the orientation determinant in integer arithmetic, for whole coordinates below 2^30.
int whole_orientation(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d)
{
    Whole u[3], v[3], w[3];
    for (int k = 0; k < 3; ++k) {
        u[k] = Whole(b[k]) - Whole(a[k]);
        v[k] = Whole(c[k]) - Whole(a[k]);
        w[k] = Whole(d[k]) - Whole(a[k]);
    }
    const Whole value =
        u[0] * (v[1] * w[2] - v[2] * w[1]) + u[1] * (v[2] * w[0] - v[0] * w[2]) + u[2] * (v[0] * w[1] - v[1] * w[0]);
    return value > 0 ? 1 : value < 0 ? -1 : 0;
}

const Triangle base{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)};

Triangle moved(const Triangle& t, const Vec3& by) { return {t[0] + by, t[1] + by, t[2] + by}; }

std::vector<IntersectingPair> all_pairs(const TriangleMesh& mesh)
{
    std::vector<IntersectingPair> pairs;
    const auto triangle = [&](int f) {
        return Triangle{mesh.vertices[mesh.faces[f][0]], mesh.vertices[mesh.faces[f][1]],
                        mesh.vertices[mesh.faces[f][2]]};
    };
    for (int a = 0; a < int(mesh.faces.size()); ++a)
        for (int b = a + 1; b < int(mesh.faces.size()); ++b)
            if (triangles_meet(triangle(a), triangle(b))) pairs.push_back({a, b});
    return pairs;
}

}  // namespace

TEST_CASE("the side of a plane is determined without error where double precision is not enough")
{
    std::mt19937 random(7);
    std::uniform_int_distribution<int> big(-(1 << 29), 1 << 29), small(-2, 2);
    int on_plane = 0, rounded_wrong = 0;
    for (int round = 0; round < 20000; ++round) {
        Vec3 a, b, c;
        for (Vec3* x : {&a, &b, &c})
            for (int k = 0; k < 3; ++k) (*x)[k] = big(random);
        // A point of the plane, moved by at most 2 along one axis: its sign depends on the determinant's last digits.
        Vec3 d = a + small(random) * (b - a) + small(random) * (c - a);
        if (d.cwiseAbs().maxCoeff() > 1e9) continue;
        d[round % 3] += small(random);
        const int wanted = whole_orientation(a, b, c, d);
        REQUIRE(exact_orientation(a, b, c, d) == wanted);
        const double plain = (b - a).cross(c - a).dot(d - a);
        on_plane += wanted == 0;
        rounded_wrong += (plain > 0 ? 1 : plain < 0 ? -1 : 0) != wanted;
    }
    CHECK(on_plane > 1000);
    CHECK(rounded_wrong > 100);
}

TEST_CASE("triangles intersect if they cross, touch or overlap, and only then")
{
    const Triangle upright{Vec3(0.2, 0.2, -1), Vec3(0.2, 0.2, 1), Vec3(3, 3, 0)};
    CHECK(triangles_meet(base, upright));
    CHECK(triangles_meet(upright, base));
    CHECK_FALSE(triangles_meet(base, moved(upright, {1, 1, 0})));
    CHECK_FALSE(triangles_meet(base, moved(base, {0, 0, 1e-300})));
    CHECK(triangles_meet(base, moved(base, {0.9, 0, 0})));
    CHECK(triangles_meet(base, moved(base, {1, 0, 0})));  // corner on corner
    CHECK_FALSE(triangles_meet(base, moved(base, {1.0000000001, 0, 0})));
    CHECK(triangles_meet(base, {Vec3(0.25, 0.25, 0), Vec3(0, 0, 1), Vec3(1, 1, 1)}));        // a corner on the face
    CHECK(triangles_meet(base, {Vec3(0.5, -1, 0), Vec3(0.5, 3, 0), Vec3(0.5, 0, 1)}));       // an edge in the plane
    CHECK(triangles_meet(base, {Vec3(0.1, 0.1, 0), Vec3(0.2, 0.1, 0), Vec3(0.1, 0.2, 0)}));  // one within the other
    CHECK(is_degenerate({Vec3(0, 0, 0), Vec3(1, 2, 3), Vec3(-2, -4, -6)}));
    CHECK(is_degenerate({Vec3(1, 1, 1), Vec3(1, 1, 1), Vec3(2, 0, 5)}));
    CHECK_FALSE(is_degenerate({Vec3(0, 0, 0), Vec3(1, 2, 3), Vec3(-2, -4, -6 + 1e-15)}));
}

TEST_CASE("the self-intersections of a mesh are those that a test of all pairs finds")
{
    std::mt19937 random(11);
    std::uniform_real_distribution<double> place(-1, 1), size(-0.15, 0.15);
    TriangleMesh mesh;
    for (int f = 0; f < 700; ++f) {
        const Vec3 at(place(random), place(random), place(random));
        for (int k = 0; k < 3; ++k) mesh.vertices.push_back(at + Vec3(size(random), size(random), size(random)));
        mesh.faces.push_back({3 * f, 3 * f + 1, 3 * f + 2});
    }
    const auto wanted = all_pairs(mesh);
    REQUIRE(wanted.size() > 100);
    CHECK(self_intersections(mesh.vertices, mesh.faces) == wanted);
}

TEST_CASE("triangles with common corners intersect only if they cross elsewhere")
{
    CHECK(self_intersections(sphere_mesh({0, 0, 0}, 1, 2).vertices, sphere_mesh({0, 0, 0}, 1, 2).faces).empty());
    // Two triangles share one corner and are apart otherwise. Then the far edge of one passes through the other.
    const std::vector<Face> faces{{0, 1, 2}, {0, 3, 4}};
    std::vector<Vec3> x{{0, 0, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 0, -1}, {-1, 0, 1}};
    CHECK(self_intersections(x, faces).empty());
    x[3].x() = x[4].x() = 0.5;
    CHECK(self_intersections(x, faces) == std::vector<IntersectingPair>{{0, 1}});
    // A triangle is folded flat onto its neighbour along their common edge.
    CHECK(self_intersections({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.1, 0.9, 0}}, {{0, 1, 2}, {1, 0, 3}}).empty());
}

TEST_CASE("pairs of a cloth and a body are found, also where no vertex is inside")
{
    const TriangleMesh needle = cone_mesh({0.3, 0.2, -1}, 0.01, 2);
    const std::vector<Vec3> x{{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
    const std::vector<Face> faces{{0, 1, 2}, {0, 2, 3}};
    const auto pairs = mutual_intersections(x, faces, needle);
    REQUIRE_FALSE(pairs.empty());
    for (const auto& [cloth, body] : pairs) CHECK(cloth == 0);
    CHECK(mutual_intersections(x, faces, sphere_mesh({0, 0, 2}, 1.9, 3)).empty());
}
