#include <algorithm>
#include <limits>
#include <memory>

#include "host/collision/parted_body.hpp"
#include "host/mesh/body_tessellation.hpp"
#include "validation/unit/catch.hpp"

using namespace selvage;

namespace {

constexpr double radius = 0.08, room = 0.008;

// Two balls beside each other along x, in one mesh. @param apart  distance of their surfaces, below 0 if they overlap
Body two_balls(double apart)
{
    Body body;
    body.mesh = sphere_mesh({-radius - 0.5 * apart, 0, 0}, radius, 4);
    const TriangleMesh other = sphere_mesh({radius + 0.5 * apart, 0, 0}, radius, 4);
    body.mesh.vertices.emplace_back(-1, 0, 1);  // the balls are in the lower half
    const int first = int(body.mesh.vertices.size());
    body.mesh.vertices.insert(body.mesh.vertices.end(), other.vertices.begin(), other.vertices.end());
    for (const Face& face : other.faces) body.mesh.faces.push_back({face[0] + first, face[1] + first, face[2] + first});
    body.mesh.vertices.emplace_back(1, 0, 1);
    return body;
}

// Width of the gap between the balls along x [m].
double gap_of(const Body& body)
{
    const auto middle = body.mesh.vertices.begin() + std::ptrdiff_t(body.mesh.vertices.size() / 2);
    double left = -1, right = 1;
    for (auto x = body.mesh.vertices.begin(); x < middle; ++x) left = std::max(left, x->x());
    for (auto x = middle; x < body.mesh.vertices.end(); ++x) right = std::min(right, x->x());
    return right - left;
}

// Ways of seams that pass beside each other along y. @param x  of all of them [m]
std::vector<SeamWay> seams_at(double x)
{
    std::vector<SeamWay> ways;
    for (const double z : {-0.08, -0.04, 0.0, 0.04, 0.08}) ways.push_back({Vec3(x, -0.2, z), Vec3(x, 0.2, z)});
    return ways;
}

}  // namespace

TEST_CASE("parts of a body that touch or overlap give way until there is room between them")
{
    for (const double apart : {0.002, 0.0003, -0.003}) {
        const Body body = two_balls(apart), parted = parted_bodies({body}, room, seams_at(0))[0];
        CHECK(gap_of(parted) > 0.95 * room);
        CHECK(gap_of(parted) < 1.3 * room);
        for (std::size_t v = 0; v < body.mesh.vertices.size(); ++v) {
            const Vec3 &from = body.mesh.vertices[v], &to = parted.mesh.vertices[v];
            CHECK((to - from).norm() < 0.5 * (room - apart) + 0.001);
            if (std::abs(from.x()) > radius) CHECK(to == from);
        }
    }
}

TEST_CASE("a body whose parts have room, or between which no seam closes, or that moves stays as it is")
{
    const Body apart = two_balls(2 * room), touching = two_balls(0);
    CHECK(parted_bodies({apart}, room, seams_at(0))[0].mesh.vertices == apart.mesh.vertices);
    CHECK(parted_bodies({touching}, room, seams_at(0.15))[0].mesh.vertices == touching.mesh.vertices);
    CHECK(parted_bodies({touching}, room, {})[0].mesh.vertices == touching.mesh.vertices);
    const SeamWay closed{Vec3::Zero(), Vec3::Zero()};  // from the start
    CHECK(parted_bodies({touching}, room, {closed})[0].mesh.vertices == touching.mesh.vertices);
    Body moving = touching;
    moving.motion = std::make_shared<BodyMotion>(std::vector<MotionKey>{}, false, Vec3::Zero());
    CHECK(parted_bodies({moving}, room, seams_at(0))[0].mesh.vertices == moving.mesh.vertices);
}
