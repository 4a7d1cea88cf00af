#include <cmath>
#include <numbers>
#include <random>

#include "host/collision/body_query.hpp"
#include "host/mesh/body_tessellation.hpp"
#include "host/model/body.hpp"
#include "host/scene/body_model.hpp"
#include "io/scene/read_scene.hpp"
#include "validation/unit/catch.hpp"
#include "validation/unit/scratch_file.hpp"

using namespace selvage;

namespace {

const Box everywhere(Vec3::Constant(-10), Vec3::Constant(10));
constexpr double pi = std::numbers::pi;

struct Answers {
    int count, stride;
    std::vector<double> position, normal, offset;
    std::vector<int> body;

    explicit Answers(const std::vector<Vec3>& points)
        : count(int(points.size())), stride(count), position(3 * stride), normal(3 * stride), offset(count), body(count)
    {
        for (int v = 0; v < count; ++v)
            for (int c = 0; c < 3; ++c) position[c * stride + v] = points[v][c];
    }
    void ask(BodyQuery& query, double radius)
    {
        query.nearest(position.data(), stride, count, radius, {stride, normal.data(), offset.data(), body.data()});
    }
    double worst_difference(const Answers& other) const
    {
        double worst = 0;
        for (int v = 0; v < count; ++v) {
            if (body[v] != other.body[v]) return 1e9;
            worst = std::max(worst, std::abs(offset[v] - other.offset[v]));
            for (int c = 0; c < 3; ++c)
                worst = std::max(worst, std::abs(normal[c * stride + v] - other.normal[c * stride + v]));
        }
        return worst;
    }
};

std::vector<Vec3> random_points(int count, double half_width)
{
    std::mt19937 random(5);
    std::uniform_real_distribution<double> coordinate(-half_width, half_width);
    std::vector<Vec3> points(count);
    for (Vec3& x : points)
        for (int c = 0; c < 3; ++c) x[c] = coordinate(random);
    return points;
}

Body body_of(const TriangleMesh& mesh, std::shared_ptr<const BodyMotion> motion = nullptr)
{
    Body body;
    body.mesh = mesh;
    body.motion = std::move(motion);
    return body;
}

const Vec3 pivot(0.1, -0.2, 0.3);

std::shared_ptr<BodyMotion> tumble()
{
    return std::make_shared<BodyMotion>(
        std::vector<MotionKey>{{}, {1, Vec3(0.3, 0, 0.2), Vec3(0, 0, pi)}, {1.5, Vec3(0, 0.1, 0), Vec3(0.7, -0.4, pi)}},
        true, pivot);
}

// The motion of a ball that stretches to an egg within one second.
std::shared_ptr<BodyMotion> swelling(const TriangleMesh& ball)
{
    auto motion = std::make_shared<BodyMotion>(std::vector<MotionKey>{}, false, Vec3::Zero());
    motion->add_pose(0, ball.vertices, false);
    std::vector<Vec3> egg = ball.vertices;
    for (Vec3& x : egg) x.z() *= 1.4;
    motion->add_pose(1, egg, false);
    return motion;
}

Scene scene_with(const std::string& text)
{
    const ScratchFolder folder;
    return read_scene(folder.write("scene.toml", "[[sheet]]\nresolution = 3\n" + text), {});
}

}  // namespace

TEST_CASE("a body passes through its keyframes and stays at the last")
{
    const auto motion = tumble();
    CHECK((motion->placement(0).matrix() - Eigen::Matrix4d::Identity()).norm() < 1e-15);
    const Placement there = motion->placement(1);
    CHECK((there * pivot - (pivot + Vec3(0.3, 0, 0.2))).norm() < 1e-14);
    CHECK((there.linear() * Vec3::UnitX() + Vec3::UnitX()).norm() < 1e-14);
    // The smooth interpolation 3 s^2 - 2 s^3 at s = 1/4.
    CHECK((motion->placement(0.25) * pivot - pivot - 0.15625 * Vec3(0.3, 0, 0.2)).norm() < 1e-14);
    CHECK(motion->end() == 1.5);
    CHECK((motion->placement(9).matrix() - motion->placement(1.5).matrix()).norm() == 0);
}

TEST_CASE("the bound of a body's displacement holds for every vertex and is at most twice the largest")
{
    const TriangleMesh ball = sphere_mesh({0.2, 0, 0.1}, 0.3, 3);
    Box box;
    for (const Vec3& x : ball.vertices) box.extend(x);
    for (const auto& motion : {tumble(), swelling(ball)})
        for (const auto& [from, to] : {std::pair(0.0, 0.1), {0.4, 0.45}, {0.9, 1.2}, {1.6, 2.0}}) {
            double longest = 0;
            const Body body = body_of(ball, motion);
            const TriangleMesh before = body_mesh_at(body, from), after = body_mesh_at(body, to);
            for (std::size_t v = 0; v < ball.vertices.size(); ++v)
                longest = std::max(longest, (after.vertices[v] - before.vertices[v]).norm());
            CHECK(motion->distance(from, to, box) >= longest - 1e-12);
            CHECK(motion->distance(from, to, box) <= 2 * longest + 1e-12);
        }
}

TEST_CASE("queries of a moved mesh have the answers of the same mesh built at its new position")
{
    const TriangleMesh tube = capsule_mesh({-0.2, 0, 0}, {0.3, 0.1, 0}, 0.15), ball = sphere_mesh({0, 0, 0}, 0.3, 3);
    for (const Body& body : {body_of(tube, tumble()), body_of(ball, swelling(ball))}) {
        BodyQuery moving({body}, everywhere);
        Answers answers(random_points(2000, 0.8));
        answers.ask(moving, 0.3);
        for (const double time : {0.1, 0.5, 0.51, 1.3, 0.2}) {
            moving.move_to(time);
            BodyQuery fresh({body_of(body_mesh_at(body, time))}, everywhere);
            Answers expected(random_points(2000, 0.8));
            answers.ask(moving, 0.3);
            expected.ask(fresh, 0.3);
            CHECK(answers.worst_difference(expected) < 1e-9);
            const BodyGap gap = moving.measure(answers.position.data(), answers.stride, answers.count);
            const BodyGap wanted = fresh.measure(answers.position.data(), answers.stride, answers.count);
            CHECK(gap.min_gap_m == Approx(wanted.min_gap_m).margin(1e-12));
            CHECK(gap.vertices_inside == wanted.vertices_inside);
        }
    }
}

TEST_CASE("queries that are skipped while bodies move do not change the answers")
{
    Body ball;
    ball.kind = Body::Kind::sphere;
    ball.radius = 0.05;
    ball.mesh = sphere_mesh({0, 0, 0}, 0.05, 3);
    ball.motion = std::make_shared<BodyMotion>(std::vector<MotionKey>{{}, {1, Vec3(0.6, 0, 0), Vec3::Zero()}}, false,
                                               Vec3::Zero());
    BodyQuery walking({ball}, everywhere);
    Answers answers(random_points(1000, 0.5));
    for (int step = 0; step <= 50; ++step) {
        walking.move_to(0.02 * step);
        answers.ask(walking, 0.03);
        BodyQuery fresh({ball}, everywhere);
        fresh.move_to(0.02 * step);
        Answers expected(random_points(1000, 0.5));
        expected.ask(fresh, 0.03);
        REQUIRE(answers.worst_difference(expected) < 1e-12);
    }
    CHECK(walking.counts().skipped > walking.counts().made);
}

TEST_CASE("the surface velocity of a body is that of the material points of its surface")
{
    const TriangleMesh ball = sphere_mesh({0, 0, 0}, 0.3, 4);
    auto spin = std::make_shared<BodyMotion>(std::vector<MotionKey>{{}, {1, Vec3(0.5, 0, 0), Vec3(0, 0, 2)}}, false,
                                             Vec3::Zero());
    const std::vector<Vec3> points{{0.31, 0, 0}, {0, 0, 0.305}, {2, 2, 2}};
    BodyQuery turning({body_of(ball, spin)}, everywhere), growing({body_of(ball, swelling(ball))}, everywhere);
    Answers on_turning(points), on_growing(points);
    on_turning.ask(turning, 0.05);
    on_growing.ask(growing, 0.05);
    const double dt = 1e-4;
    turning.move_to(dt);
    growing.move_to(dt);
    CHECK((turning.surface_velocity(0, points[0], dt) - Vec3(0.5, 0.62, 0)).norm() < 1e-3);
    CHECK((turning.surface_velocity(1, points[1], dt) - Vec3(0.5, 0, 0)).norm() < 1e-9);
    CHECK(turning.surface_velocity(2, points[2], dt).norm() == 0);
    CHECK((growing.surface_velocity(1, points[1], dt) - Vec3(0, 0, 0.12)).norm() < 1e-3);
    CHECK(growing.surface_velocity(0, points[0], dt).norm() < 5e-3);
}

TEST_CASE("crossings of a moving body are those of the paths relative to the body")
{
    Body ball;
    ball.kind = Body::Kind::sphere;
    ball.radius = 0.1;
    ball.mesh = sphere_mesh({0, 0, 0}, 0.1, 4);
    ball.motion =
        std::make_shared<BodyMotion>(std::vector<MotionKey>{{}, {1, Vec3(1, 0, 0), Vec3::Zero()}}, false, Vec3::Zero());
    Body mesh = ball;
    mesh.kind = Body::Kind::mesh;
    for (const Body& body : {ball, mesh}) {
        BodyQuery query({body}, everywhere);
        query.move_to(0.3);
        // The first point moves little and the body reaches it, the second moves away faster than the body, and the
        // third is at rest and the body passes over it.
        const Answers from({{0.2, 0, 0}, {0.2, 0, 0}, {0.15, 0.01, 0}}),
            to({{0.25, 0, 0}, {0.5, 0, 0}, {0.15, 0.01, 0}});
        const auto found = query.crossings(from.position.data(), to.position.data(), from.stride, from.count);
        CHECK(found[0].body == 0);
        CHECK(found[1].body == -1);
        CHECK(found[2].body == 0);
        CHECK(found[0].way_beyond == Approx(0.15).margin(1e-3));
        query.move_to(0.3);  // the body does not move, so the relative paths are the given ones
        CHECK(query.crossings(from.position.data(), to.position.data(), from.stride, from.count)[2].body == -1);
    }
}

TEST_CASE("the longest step is the one that moves no body further than the given distance")
{
    BodyQuery query({body_of(sphere_mesh({0, 0, 0}, 0.3, 3), tumble())}, everywhere);
    CHECK(query.longest_step(2, 0.5, 0.01, everywhere) == 0.5);
    const double dt = query.longest_step(0.5, 0.5, 0.01, everywhere);
    CHECK(dt < 0.02);
    CHECK(dt > 0.001);
    const Vec3 far(20, 0, 0);
    CHECK(query.longest_step(0.5, 0.5, 0.01, {far, far + Vec3::Ones()}) == 0.5);
}

TEST_CASE("the mannequin raises its arms and leaves its trunk where it is")
{
    const Scene scene = scene_with("[[body]]\nshape = \"mannequin\"\n[[body.keyframe]]\ntime = 1\narm_angle = 0\n");
    std::vector<Finding> findings;
    const std::vector<Body> bodies = build_bodies(scene, findings);
    REQUIRE(bodies.at(0).motion);
    const TriangleMesh before = body_mesh_at(bodies[0], 0), after = body_mesh_at(bodies[0], 1);
    double highest_hand = 0, span = 0, trunk_moved = 0;
    for (std::size_t v = 0; v < before.vertices.size(); ++v) {
        const Vec3 &a = before.vertices[v], &b = after.vertices[v];
        if (std::abs(b.x()) > 0.6) highest_hand = std::max(highest_hand, b.z());
        span = std::max(span, b.x());
        if (std::abs(a.x()) < 0.1 || a.z() < 0.6) trunk_moved = std::max(trunk_moved, (a - b).norm());
    }
    CHECK(span > 0.85);
    CHECK(highest_hand > 1.3);
    CHECK(trunk_moved < 1e-3);
    CHECK(signed_volume(after) == Approx(signed_volume(before)).epsilon(0.02));
}

TEST_CASE("a sequence of meshes and a single target pose move a body, and other faces are refused")
{
    const ScratchFolder folder;
    const auto tetrahedron = [&](const char* name, double height, const char* face = "f 1 2 4") {
        return folder.write(name, "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 " + std::to_string(height) + "\nf 1 3 2\n" + face +
                                      "\nf 2 3 4\nf 3 1 4\n");
    };
    tetrahedron("pose_1.obj", 1);
    tetrahedron("pose_2.obj", 2);
    tetrahedron("pose_3.obj", 4);
    tetrahedron("other.obj", 4, "f 2 4 1");
    const auto built = [&](const std::string& body) {
        const std::string text = "[[sheet]]\nresolution = 3\n[[body]]\nshape = \"mesh\"\n" + body;
        std::vector<Finding> findings;
        return build_bodies(read_scene(folder.write("scene.toml", text), {}), findings).at(0);
    };
    const Body sequence = built("sequence = \"pose_*.obj\"\nsequence_rate = 2\n");
    CHECK(sequence.motion->end() == 1);
    CHECK(body_mesh_at(sequence, 0.25).vertices[3].z() == Approx(1.5));
    CHECK(body_mesh_at(sequence, 0.75).vertices[3].z() == Approx(3));
    const Body morph = built(
        "mesh = \"pose_1.obj\"\n[[body.keyframe]]\ntime = 1\n[[body.keyframe]]\ntime = 3\n"
        "mesh = \"pose_3.obj\"\n");
    CHECK(body_mesh_at(morph, 1).vertices[3].z() == 1);
    CHECK(body_mesh_at(morph, 2).vertices[3].z() == Approx(2.5));
    CHECK_THROWS_WITH(built("mesh = \"pose_1.obj\"\n[[body.keyframe]]\ntime = 1\nmesh = \"other.obj\"\n"),
                      contains_text("other.obj"));
    CHECK_THROWS_WITH(built("sequence = \"none_*.obj\"\n"), contains_text("body[0].sequence"));
}
