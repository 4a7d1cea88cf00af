#include "host/scene/body_shapes.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>
#include <Eigen/Geometry>

#include "host/mesh/body_tessellation.hpp"
#include "host/model/body.hpp"

namespace selvage {
namespace {

constexpr double drawn_plane_width = 4;  // [m]
constexpr double flattest = 1.2e-4;      // how far a sphere may rise above its tessellation, if a level does it [m]
constexpr double least_length = 1e-6;    // a direction shorter than this [m] cannot be meant

std::string body_key(int index, const char* key) { return fmt::format("body[{}].{}", index, key); }

Body named_body(const BodyScene& body_scene, int index)
{
    Body body;
    body.name = body_scene.name.empty() ? fmt::format("{}_{}", word_of(body_scene.shape), index) : body_scene.name;
    body.center = body_scene.center;
    body.friction = body_scene.friction;
    return body;
}

std::string vector_text(const Vec3& v) { return fmt::format("[{}, {}, {}]", v.x(), v.y(), v.z()); }

void check_faces(const TriangleMesh& mesh, const Scene& scene, int index)
{
    const InputPlace place = scene.place(body_key(index, "mesh"));
    if (mesh.faces.empty()) throw InputError(place, "a mesh without faces", "a mesh with at least one triangle");
    const int vertex_count = int(mesh.vertices.size());
    for (std::size_t f = 0; f < mesh.faces.size(); ++f)
        for (const int vertex : mesh.faces[f])
            if (vertex < 0 || vertex >= vertex_count)
                throw InputError(place, fmt::format("face {} with vertex {}", f + 1, vertex + 1),
                                 fmt::format("vertex numbers from 1 to {}", vertex_count));
}

Mat3 rotation_matrix(const Vec3& degrees)
{
    const Vec3 angle = degrees * (std::numbers::pi / 180);
    return (Eigen::AngleAxisd(angle.z(), Vec3::UnitZ()) * Eigen::AngleAxisd(angle.y(), Vec3::UnitY()) *
            Eigen::AngleAxisd(angle.x(), Vec3::UnitX()))
        .toRotationMatrix();
}

// Turns and shifts a loaded mesh, which has its size already.
void place(const BodyScene& body_scene, std::vector<Vec3>& vertices)
{
    const Mat3 turn = rotation_matrix(body_scene.rotation);
    for (Vec3& vertex : vertices) vertex = turn * vertex + body_scene.center;
}

// Level of the icosahedron's refinement: the middle of a face of level k is about 0.18 / 4^k radii below the sphere.
int sphere_level(double radius)
{
    int level = 3;
    while (level < 5 && 0.18 * radius / (1 << 2 * level) > flattest) ++level;
    return level;
}

}  // namespace

Body make_body(const BodyScene& body_scene, const Scene& scene, int index)
{
    Body body = named_body(body_scene, index);
    if (body_scene.shape == BodyShape::sphere) {
        body.kind = Body::Kind::sphere;
        body.radius = body_scene.radius;
        body.mesh = sphere_mesh(body.center, body.radius, sphere_level(body.radius));
    } else if (body_scene.shape == BodyShape::plane) {
        body.kind = Body::Kind::plane;
        if (!(body_scene.normal.norm() > least_length))
            throw InputError(scene.place(body_key(index, "normal")), vector_text(body_scene.normal),
                             "a direction that is not zero");
        body.normal = body_scene.normal.normalized();
        body.mesh = square_mesh(body.center, body.normal, drawn_plane_width);
    } else if (body_scene.shape == BodyShape::capsule) {
        body.kind = Body::Kind::capsule;
        body.end = body_scene.end;
        body.radius = body_scene.radius;
        if (!((body.end - body.center).norm() > least_length))
            throw InputError(scene.place(body_key(index, "end")), vector_text(body.end),
                             "a point apart from `center`; use shape = \"sphere\" for a ball");
        body.mesh = capsule_mesh(body.center, body.end, body.radius);
    } else if (body_scene.shape == BodyShape::cylinder) {
        body.mesh = cylinder_mesh(body.center, body_scene.radius, body_scene.height);
    } else if (body_scene.shape == BodyShape::cone) {
        body.mesh = cone_mesh(body.center, body_scene.radius, body_scene.height);
    } else if (body_scene.shape == BodyShape::torus) {
        body.mesh = torus_mesh(body.center, body_scene.normal.normalized(), body_scene.radius, body_scene.tube);
    } else {
        throw std::logic_error("make_body: shape \"" + text_of(body_scene.shape) + "\" needs a loaded mesh");
    }
    return body;
}

Body make_body(const BodyScene& body_scene, const Scene& scene, int index, const TriangleMesh& loaded)
{
    check_faces(loaded, scene, index);
    Body body = named_body(body_scene, index);
    body.mesh = loaded;
    place(body_scene, body.mesh.vertices);
    return body;
}

void add_motion(Body& body, const BodyScene& body_scene, std::vector<LoadedPose> poses)
{
    if (!body_scene.moves()) return;
    std::vector<MotionKey> keys;
    const bool rigid = std::any_of(body_scene.keyframes.begin(), body_scene.keyframes.end(),
                                   [](const auto& key) { return !key.translation.isZero() || !key.rotation.isZero(); });
    if (rigid) keys.push_back({});
    for (const KeyframeScene& key : body_scene.keyframes)
        if (rigid) keys.push_back({key.time, key.translation, key.rotation * (std::numbers::pi / 180)});
    auto motion = std::make_shared<BodyMotion>(std::move(keys), body_scene.interpolation == Interpolation::smooth,
                                               body_scene.center);
    if (!poses.empty()) motion->add_pose(0, body.mesh.vertices, false);
    for (LoadedPose& pose : poses) {
        place(body_scene, pose.vertices);
        motion->add_pose(pose.time, std::move(pose.vertices), pose.smooth);
    }
    body.motion = std::move(motion);
}

}  // namespace selvage
