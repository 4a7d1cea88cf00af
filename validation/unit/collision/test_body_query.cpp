#include <cmath>
#include <random>

#include <tbb/global_control.h>

#include "host/collision/body_query.hpp"
#include "host/mesh/body_tessellation.hpp"
#include "host/model/body.hpp"
#include "validation/measure/closed_surface.hpp"
#include "validation/unit/catch.hpp"

using namespace selvage;

namespace {

const Box everywhere(Vec3::Constant(-10), Vec3::Constant(10));

/// Positions in component planes with room for the answers.
struct Points {
    int count, stride;
    std::vector<double> position, normal, offset;
    std::vector<int> body;

    explicit Points(const std::vector<Vec3>& points)
        : count(int(points.size())), stride(count + 5), position(3 * stride), normal(3 * stride), offset(count),
          body(count)
    {
        for (int v = 0; v < count; ++v) set(v, points[v]);
    }
    void set(int v, const Vec3& x)
    {
        for (int c = 0; c < 3; ++c) position[c * stride + v] = x[c];
    }
    Vec3 at(const std::vector<double>& planes, int v) const
    {
        return {planes[v], planes[stride + v], planes[2 * stride + v]};
    }
    void ask(BodyQuery& query, double radius)
    {
        query.nearest(position.data(), stride, count, radius, {stride, normal.data(), offset.data(), body.data()});
    }
    double gap(int v) const { return at(normal, v).dot(at(position, v)) - offset[v]; }
};

Body mesh_body(const TriangleMesh& mesh)
{
    Body body;
    body.mesh = mesh;
    return body;
}

TriangleMesh box_mesh(const Vec3& half)
{
    TriangleMesh mesh;
    for (int k = 0; k < 8; ++k)
        mesh.vertices.emplace_back(k & 1 ? half.x() : -half.x(), k & 2 ? half.y() : -half.y(),
                                   k & 4 ? half.z() : -half.z());
    mesh.faces = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                  {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
    return mesh;
}

/// Exact signed distance to a box around the origin.
double box_distance(const Vec3& x, const Vec3& half)
{
    const Vec3 q = x.cwiseAbs() - half;
    return q.cwiseMax(0).norm() + std::min(q.maxCoeff(), 0.0);
}

/// A valley along y between two slopes of 45 degrees, closed below.
TriangleMesh valley_mesh()
{
    TriangleMesh mesh;
    for (const double y : {-1.0, 1.0})
        for (const auto& [x, z] : {std::pair(-1.0, 1.0), {0.0, 0.0}, {1.0, 1.0}, {1.0, -1.0}, {-1.0, -1.0}})
            mesh.vertices.emplace_back(x, y, z);
    for (int k = 0; k < 5; ++k) {
        const int next = (k + 1) % 5;
        mesh.faces.push_back({k, next + 5, next});
        mesh.faces.push_back({k, k + 5, next + 5});
    }
    for (const Face& f : {Face{1, 3, 4}, Face{1, 4, 0}, Face{1, 2, 3}}) {
        mesh.faces.push_back({f[0], f[2], f[1]});
        mesh.faces.push_back({f[0] + 5, f[1] + 5, f[2] + 5});
    }
    if (signed_volume(mesh) < 0)
        for (Face& f : mesh.faces) std::swap(f[1], f[2]);
    return mesh;
}

std::vector<Vec3> random_points(int count, double half_width, unsigned seed = 3)
{
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> coordinate(-half_width, half_width);
    std::vector<Vec3> points(count);
    for (Vec3& x : points)
        for (int c = 0; c < 3; ++c) x[c] = coordinate(random);
    return points;
}

std::vector<Vec3> straight_path(const Vec3& from, const Vec3& to, int count)
{
    std::vector<Vec3> path;
    for (int k = 0; k < count; ++k) path.push_back(from + (to - from) * (double(k) / (count - 1)));
    return path;
}

struct Jumps {
    double gap = 0, normal = 0;
};

/// Largest changes of gap and normal between neighbouring points of a path, all of which must have contacts.
Jumps largest_jumps(const std::vector<Body>& bodies, const std::vector<Vec3>& path, double radius)
{
    BodyQuery query(bodies, everywhere);
    Points points(path);
    points.ask(query, radius);
    Jumps jumps;
    for (int v = 0; v < points.count; ++v) {
        REQUIRE(points.body[v] == 0);
        if (v == 0) continue;
        jumps.gap = std::max(jumps.gap, std::abs(points.gap(v) - points.gap(v - 1)));
        jumps.normal = std::max(jumps.normal, (points.at(points.normal, v) - points.at(points.normal, v - 1)).norm());
    }
    return jumps;
}

Body sphere_body(double radius)
{
    Body body;
    body.kind = Body::Kind::sphere;
    body.radius = radius;
    body.mesh = sphere_mesh(Vec3::Zero(), radius, 2);
    return body;
}

Body capsule_body(const Vec3& first, const Vec3& last, double radius)
{
    Body body;
    body.kind = Body::Kind::capsule;
    body.center = first;
    body.end = last;
    body.radius = radius;
    body.mesh = capsule_mesh(first, last, radius);
    return body;
}

}  // namespace

TEST_CASE("the nearest triangle is the one that trying all of them finds", "[body]")
{
    const BodySurface surface(sphere_mesh({0.1, 0, 0}, 0.5, 2));
    const EmbreeDevice device;
    const BodyBvh bvh(device, surface, everywhere);
    for (const Vec3& x : random_points(500, 0.8)) {
        double least = 1e9;
        for (int t = 0; t < surface.triangle_count(); ++t)
            least = std::min(least, surface.closest(x, t).squared_distance);
        const NearestTriangle found = bvh.nearest(x, bvh.far_radius(x));
        REQUIRE(found.triangle >= 0);
        CHECK(found.squared_distance == least);
        CHECK(bvh.nearest(x, bvh.far_radius(x), 7).triangle == found.triangle);
        CHECK(bvh.nearest(x, 0.999 * std::sqrt(least)).triangle == -1);
    }
}

TEST_CASE("the closest point of a triangle beats a dense sampling of it", "[body]")
{
    const std::vector<Vec3> points = random_points(400, 1, 11);
    for (std::size_t k = 0; k + 3 < points.size(); k += 4) {
        const Vec3 &x = points[k], &a = points[k + 1], &b = points[k + 2], &c = points[k + 3];
        const ClosestOnTriangle closest = closest_on_triangle(x, a, b, c);
        double least = 1e9;
        for (int i = 0; i <= 40; ++i)
            for (int j = 0; i + j <= 40; ++j)
                least = std::min(least, (a + (b - a) * (i / 40.0) + (c - a) * (j / 40.0) - x).norm());
        CHECK(std::sqrt(closest.squared_distance) <= least + 1e-12);
        CHECK(std::sqrt(closest.squared_distance) >= least - 0.08);
        CHECK(closest.weights.minCoeff() >= -1e-12);
        const Vec3 mixed = closest.weights[0] * a + closest.weights[1] * b + closest.weights[2] * c;
        CHECK((mixed - closest.point).norm() < 1e-12);
    }
}

TEST_CASE("signed distances to a box mesh are exact inside and outside", "[body]")
{
    const Vec3 half(0.3, 0.2, 0.4);
    const BodyQuery query({mesh_body(box_mesh(half))}, everywhere);
    int inside = 0;
    double smallest = 1e9;
    const std::vector<Vec3> points = random_points(400, 0.6);
    for (const Vec3& x : points) {
        Points one({x});
        const BodyGap gap = query.measure(one.position.data(), one.stride, 1);
        const double expected = box_distance(x, half);
        CHECK(gap.min_gap_m == Approx(expected).margin(1e-12));
        CHECK(gap.vertices_inside == (expected < 0));
        inside += expected < 0;
        smallest = std::min(smallest, expected);
    }
    Points all(points);
    const BodyGap gap = query.measure(all.position.data(), all.stride, all.count);
    CHECK(gap.vertices_inside == inside);
    CHECK(gap.max_penetration_m == Approx(-smallest));
}

TEST_CASE("a fine sphere mesh gives the contacts of the closed form", "[body]")
{
    const double radius = 0.25;
    const TriangleMesh mesh = sphere_mesh(Vec3::Zero(), radius, 5);
    double sag = 0;  // how far the facets lie inside the sphere
    for (const Face& f : mesh.faces)
        sag = std::max(sag, radius - (mesh.vertices[f[0]] + mesh.vertices[f[1]] + mesh.vertices[f[2]]).norm() / 3);
    REQUIRE(sag < 1e-4);
    BodyQuery fine({mesh_body(mesh)}, everywhere), exact({sphere_body(radius)}, everywhere);
    std::vector<Vec3> points = random_points(2000, 1);
    for (std::size_t k = 0; k < points.size(); ++k)
        points[k] = points[k].normalized() * (radius + 0.01 * (double(k % 19) / 9 - 1));
    Points a(points), b(points);
    a.ask(fine, 0.02);
    b.ask(exact, 0.02);
    for (int v = 0; v < a.count; ++v) {
        REQUIRE(a.body[v] == 0);
        REQUIRE(b.body[v] == 0);
        CHECK(std::abs(a.gap(v) - b.gap(v)) < 1.02 * sag);
        CHECK((a.at(a.normal, v) - b.at(b.normal, v)).norm() < 2e-3);
        CHECK(a.at(a.normal, v).norm() == Approx(1));
    }
}

TEST_CASE("gap and normal are continuous across the facets of a coarse sphere", "[body]")
{
    const std::vector<Body> bodies{mesh_body(sphere_mesh(Vec3::Zero(), 0.5, 2))};
    std::vector<Vec3> path;
    for (int k = 0; k < 20000; ++k) {
        const double t = 2 * 3.14159265358979 * k / 20000;
        path.push_back(0.505 * Vec3(std::cos(t), std::sin(t) * 0.8, std::sin(t) * 0.6));
    }
    const Jumps jumps = largest_jumps(bodies, path, 0.05);  // steps of 1.6e-4 m turn the radius by 3.1e-4
    CHECK(jumps.gap < 1e-4);
    CHECK(jumps.normal < 6e-4);
}

TEST_CASE("gap and normal are continuous across a concave crease", "[body]")
{
    const Jumps jumps =
        largest_jumps({mesh_body(valley_mesh())}, straight_path({-0.2, 0.1, 0.22}, {0.2, -0.1, 0.22}, 4001), 0.5);
    CHECK(jumps.gap < 0.02);
    const Jumps near =
        largest_jumps({mesh_body(valley_mesh())}, straight_path({-0.01, 0.1, 0.012}, {0.01, -0.1, 0.012}, 4001), 0.5);
    CHECK(near.gap < 1e-4);
    CHECK(near.normal < 0.03);  // the facets' normals are 1.41 apart
}

TEST_CASE("around the sharp rim of a cylinder the contact is exact and turns continuously", "[body]")
{
    const double radius = 0.09, height = 0.1;
    const std::vector<Body> bodies{mesh_body(cylinder_mesh(Vec3::Zero(), radius, height))};
    CHECK(is_closed(bodies[0].mesh));
    CHECK(signed_volume(bodies[0].mesh) == Approx(3.14159265358979 * radius * radius * height).epsilon(2e-4));

    const Vec3 out = Vec3(std::cos(0.3), std::sin(0.3), 0);
    const double off = 1e-3;  // distance of the path from the surface
    const Vec3 above(0, 0, 0.05 + off);
    std::vector<Vec3> path = straight_path(0.05 * out + above, radius * out + above, 500);
    for (int k = 1; k < 500; ++k) {
        const double t = 1.5707963 * k / 500;
        path.push_back((radius + off * std::sin(t)) * out + Vec3(0, 0, 0.05 + off * std::cos(t)));
    }
    const Vec3 beside = (radius + off) * out;
    for (const Vec3& x : straight_path(beside + Vec3(0, 0, 0.05), beside, 500)) path.push_back(x);

    BodyQuery query(bodies, everywhere);
    Points points(path);
    points.ask(query, 0.02);
    for (int v = 0; v < points.count; ++v) {
        REQUIRE(points.body[v] == 0);
        CHECK(points.gap(v) == Approx(off).epsilon(0.02));
    }
    for (int v = 0; v < 499; ++v) CHECK((points.at(points.normal, v) - Vec3::UnitZ()).norm() < 1e-9);
    CHECK((points.at(points.normal, points.count - 1) - out).norm() < 1e-3);
    CHECK(largest_jumps(bodies, path, 0.02).normal < 0.02);
}

TEST_CASE("a sharp rim keeps the gap continuous inside the cylinder", "[body]")
{
    const std::vector<Body> bodies{mesh_body(cylinder_mesh(Vec3::Zero(), 0.09, 0.1))};
    CHECK(largest_jumps(bodies, straight_path({0.06, 0, 0.048}, {0.088, 0, 0.02}, 2000), 0.05).gap < 3e-5);
}

TEST_CASE("at a needle's tip the contact falls back to the direction to the closest point", "[body]")
{
    TriangleMesh needle = cylinder_mesh(Vec3::Zero(), 0.002, 0.5, 16);
    for (Vec3& x : needle.vertices)
        if (x.z() > 0.24) x = Vec3(0, 0, 0.25);
    BodyQuery query({mesh_body(needle)}, everywhere);
    Points points({{0.0006, 0.0001, 0.2495}, {0, 0, 0.252}});
    points.ask(query, 0.01);
    const double distance = query.measure(points.position.data(), points.stride, 1).min_gap_m;
    CHECK(distance > 0.0003);
    CHECK(points.gap(0) > 0.8 * distance);
    CHECK(points.gap(0) <= distance + 1e-15);
    CHECK(points.gap(1) == Approx(0.002));
}

TEST_CASE("signs are right around acute edges and corners", "[body]")
{
    TriangleMesh sliver;
    sliver.vertices = {{0, 0, 0}, {1, 0, 0}, {0.2, 0.3, 0}, {0.1, 0.1, 0.05}};
    sliver.faces = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
    REQUIRE(signed_volume(sliver) > 0);
    const BodySurface surface(sliver);
    const BodyQuery query({mesh_body(sliver)}, everywhere);
    for (const Vec3& corner : sliver.vertices)
        for (const Vec3& shift : random_points(300, 0.05)) {
            double highest = -1e9;  // inside if below the planes of all faces
            for (int t = 0; t < 4; ++t)
                highest = std::max(highest, surface.face_normal(t).dot(corner + shift - surface.corner(t, 0)));
            const Points one({corner + shift});
            CHECK(query.measure(one.position.data(), one.stride, 1).vertices_inside == (highest < 0));
        }
}

TEST_CASE("contacts beyond the radius are not reported", "[body]")
{
    const Body ball = mesh_body(sphere_mesh(Vec3::Zero(), 0.5, 3));
    BodyQuery query({ball, capsule_body({0, 0, 2}, {0, 1, 2}, 0.1)}, everywhere);
    Points points({{0.515, 0, 0}, {0.525, 0, 0}, {0, 0.5, 2.11}, {0, 0.5, 2.13}, {0, 0.5, 2}});
    points.ask(query, 0.02);
    CHECK(points.body == std::vector<int>{0, -1, 1, -1, 1});
    CHECK(points.gap(1) > 1e6);
    CHECK(points.gap(4) == Approx(-0.1));
}

TEST_CASE("paths that enter a body are found with their fraction, and grazing ones are not", "[body]")
{
    const Vec3 half(0.3, 0.2, 0.4);
    BodyQuery query({mesh_body(box_mesh(half))}, everywhere);
    const Vec3 x(0.1, 0.05, 0);
    const std::vector<std::pair<Vec3, Vec3>> paths = {
        {x + Vec3(0, 0, 0.5), x + Vec3(0, 0, 0.3)},   // in through the top, half way
        {x + Vec3(0, 0, 0.3), x + Vec3(0, 0, 0.5)},   // out
        {x + Vec3(0, 0, 0.9), x + Vec3(0, 0, -0.9)},  // through and out again
        {{-0.5, 0, 0.4001}, {0.5, 0, 0.4001}},        // grazes the top
        {{-0.5, 0, 0.5}, {0.2, 0, 0.4000001}},        // ends just above the top
        {{0.4, 0.3, 0.5}, {0.2, 0.1, 0.3}},           // through a corner's diagonal
        {{0, 0, 0.401}, {0, 0, 0.399}},               // through the diagonal edge of two triangles
        {x + Vec3(0, 0, 0.4), x + Vec3(0, 0, 0.39)},  // starts on the surface
        {x, x},
    };
    std::vector<Vec3> from, to;
    for (const auto& [a, b] : paths) {
        from.push_back(a);
        to.push_back(b);
    }
    const Points p0(from), p1(to);
    const auto found = query.crossings(p0.position.data(), p1.position.data(), p0.stride, p0.count);
    const std::vector<double> expected = {0.5, 2, 0.5 / 1.8, 2, 2, 0.5, 0.5, 0, 2};
    for (int v = 0; v < p0.count; ++v) {
        INFO("path " << v);
        CHECK(found[v].fraction == Approx(expected[v]).margin(1e-9));
        CHECK((found[v].body == 0) == (expected[v] <= 1));
    }
    CHECK((found[0].triangle == 2 || found[0].triangle == 3));
}

TEST_CASE("random paths enter the closed forms where their gap changes sign", "[body]")
{
    Body plane;
    plane.kind = Body::Kind::plane;
    plane.normal = Vec3(1, 2, 3).normalized();
    const std::vector<Vec3> from = random_points(1500, 1, 5), to = random_points(1500, 1, 6);
    const Points p0(from), p1(to);
    for (const Body& body : {plane, sphere_body(0.5), capsule_body({-0.3, 0, 0}, {0.4, 0.2, 0.1}, 0.3)}) {
        BodyQuery query({body}, everywhere);
        const auto found = query.crossings(p0.position.data(), p1.position.data(), p0.stride, p0.count);
        int entered = 0;
        for (int v = 0; v < p0.count; ++v) {
            const auto gap_at = [&](double t) {
                Points one({from[v] + t * (to[v] - from[v])});
                return query.measure(one.position.data(), one.stride, 1).min_gap_m;
            };
            double least = 1e9;
            for (int k = 0; k <= 20; ++k) least = std::min(least, gap_at(k / 20.0));
            if (gap_at(0) < 0)
                CHECK(found[v].fraction > 1);
            else if (least < 0)
                CHECK(found[v].fraction <= 1);
            if (found[v].fraction > 1) continue;
            ++entered;
            CHECK(std::abs(gap_at(found[v].fraction)) < 1e-9);
        }
        CHECK(entered > 100);
    }
}

TEST_CASE("skipped queries change no answer over a random walk, on any number of threads", "[body]")
{
    const std::vector<Body> bodies{mesh_body(sphere_mesh(Vec3::Zero(), 0.3, 3)), mesh_body(box_mesh({0.5, 0.1, 0.1})),
                                   capsule_body({0, 0, 0.5}, {0.2, 0, 0.6}, 0.1)};
    BodyQuery walking(bodies, everywhere), fresh(bodies, everywhere);
    Points a(random_points(800, 0.8)), b = a;
    std::mt19937 random(1);
    std::normal_distribution<double> step(0, 0.004);
    for (int k = 0; k < 30; ++k) {
        for (int v = 0; v < a.count; ++v) {
            const Vec3 x = a.at(a.position, v) + Vec3(step(random), step(random), step(random));
            a.set(v, x);
            b.set(v, x);
        }
        a.ask(walking, 0.02);
        fresh.forget();
        const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
        b.ask(fresh, 0.02);
        REQUIRE(a.body == b.body);
        REQUIRE(a.offset == b.offset);
        REQUIRE(a.normal == b.normal);
    }
    CHECK(fresh.counts().skipped == 0);
    CHECK(walking.counts().skipped > walking.counts().made);
}

TEST_CASE("a small reach uses fewer triangles, gives the same answers, and grows when points leave it", "[body]")
{
    const std::vector<Body> bodies{mesh_body(sphere_mesh(Vec3::Zero(), 0.3, 4))};
    BodyQuery whole(bodies, everywhere), part(bodies, Box(Vec3(-0.2, -0.2, 0.1), Vec3(0.2, 0.2, 0.5)));
    CHECK(part.counts().triangles_used < part.counts().triangles_total / 3);
    std::vector<Vec3> points;
    for (const Vec3& x : random_points(300, 0.05)) points.push_back(x + Vec3(0, 0, 0.3));
    Points a(points), b(points);
    a.ask(whole, 0.01);
    b.ask(part, 0.01);
    CHECK(part.counts().rebuilds == 0);
    CHECK(a.offset == b.offset);

    for (Points* p : {&a, &b})
        for (int v = 0; v < p->count; ++v) p->set(v, -p->at(p->position, v));
    CHECK(part.measure(b.position.data(), b.stride, b.count).min_gap_m ==
          whole.measure(a.position.data(), a.stride, a.count).min_gap_m);
    a.ask(whole, 0.01);
    b.ask(part, 0.01);
    CHECK(part.counts().rebuilds == 1);
    CHECK(a.offset == b.offset);
    CHECK(a.normal == b.normal);
}

TEST_CASE("bodies of closed form need no ray tracing library, and without bodies no contact is found", "[body]")
{
    CHECK_FALSE(BodyQuery({sphere_body(1)}, everywhere).uses_embree());
    CHECK(BodyQuery({mesh_body(box_mesh({1, 1, 1}))}, everywhere).uses_embree());
    BodyQuery none({}, everywhere);
    CHECK(none.empty());
    Points points({{0, 0, 0}});
    points.ask(none, 0.1);
    CHECK(points.body[0] == -1);
    CHECK(std::isinf(none.measure(points.position.data(), points.stride, 1).min_gap_m));
}

TEST_CASE("a mesh split at its edges behaves like the joined one", "[body]")
{
    const TriangleMesh joined = box_mesh({0.3, 0.2, 0.4});
    TriangleMesh split;
    for (const Face& f : joined.faces) {
        const int first = int(split.vertices.size());
        for (const int vertex : f) split.vertices.push_back(joined.vertices[vertex]);
        split.faces.push_back({first, first + 1, first + 2});
    }
    CHECK(is_closed(split));
    BodyQuery one({mesh_body(joined)}, everywhere), other({mesh_body(split)}, everywhere);
    Points a(random_points(500, 0.6)), b = a;
    a.ask(one, 0.1);
    b.ask(other, 0.1);
    CHECK(a.body == b.body);
    CHECK(a.offset == b.offset);
}
