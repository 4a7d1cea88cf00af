#include "host/mesh/body_tessellation.hpp"
#include "host/model/body.hpp"
#include "host/scene/body_shapes.hpp"
#include "validation/measure/closed_surface.hpp"
#include "validation/unit/catch.hpp"

using namespace selvage;

TEST_CASE("bodies of a scene are placed as it says, and impossible ones are refused", "[body]")
{
    Scene scene;
    BodyScene body_scene;
    body_scene.rotation = Vec3(90, 0, 90);
    body_scene.center = Vec3(0, 0, 1);
    TriangleMesh mesh;
    mesh.vertices = {{0, 1, 0}, {1, 0, 0}, {0, 0, 1}};
    mesh.faces = {{0, 1, 2}};
    const Body placed = make_body(body_scene, scene, 0, mesh);
    CHECK((placed.mesh.vertices[0] - Vec3(0, 0, 2)).norm() < 1e-12);  // y to z by x; z is kept by z
    CHECK((placed.mesh.vertices[1] - Vec3(0, 1, 1)).norm() < 1e-12);  // x is kept by x; x to y by z
    CHECK((placed.mesh.vertices[2] - Vec3(1, 0, 1)).norm() < 1e-12);  // z to -y by x; -y to x by z

    mesh.faces = {{0, 1, 3}};
    CHECK_THROWS_AS(make_body(body_scene, scene, 0, mesh), InputError);
    body_scene.shape = BodyShape::plane;
    body_scene.normal = Vec3::Zero();
    CHECK_THROWS_AS(make_body(body_scene, scene, 0), InputError);
    body_scene.shape = BodyShape::capsule;
    body_scene.end = body_scene.center;
    CHECK_THROWS_AS(make_body(body_scene, scene, 0), InputError);
    for (const BodyShape shape : {BodyShape::sphere, BodyShape::cylinder}) {
        body_scene.shape = shape;
        CHECK(is_closed(make_body(body_scene, scene, 0).mesh));
    }
    CHECK(is_closed(capsule_mesh({0, 0, 1}, {1, 0, 0}, 0.2)));
    CHECK(signed_volume(capsule_mesh({0, 0, 1}, {1, 0, 0}, 0.2)) > 0);
}
