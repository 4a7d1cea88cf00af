#pragma once
#include <memory>
#include <string>

#include "host/model/body_motion.hpp"
#include "io/scene/scene.hpp"

namespace selvage {

/// An obstacle for the cloth as it starts, in the scene's frame.
struct Body {
    enum class Kind { mesh, sphere, plane, capsule };

    std::string name;
    Kind kind = Kind::mesh;
    TriangleMesh mesh;            ///< The surface [m]; for the other kinds a tessellation for files and pictures.
    Vec3 center = Vec3::Zero();   ///< Centre (sphere), a point (plane), first end (capsule) [m].
    Vec3 end = Vec3::UnitZ();     ///< Second end (capsule) [m].
    Vec3 normal = Vec3::UnitZ();  ///< Unit normal out of the body (plane).
    double radius = 0;            ///< Sphere, capsule [m].
    double friction = automatic;  ///< Coulomb coefficient; NaN: the fabric's.
    std::shared_ptr<const BodyMotion> motion;  ///< Null: it stands still.
};

/// The surface of a body at a time [s].
TriangleMesh body_mesh_at(const Body& body, double time);

/// True if any of the bodies moves.
bool any_moves(const std::vector<Body>& bodies);

/// Makes a body of a shape that needs no file: sphere, plane (drawn as a square, infinite for contact), capsule,
/// cylinder, cone (both upright, closed meshes; `center` in the middle of the cylinder's axis, of the cone's base),
/// torus (a mesh about `center`, its axis `normal`).
/// @param index  position in Scene::bodies, for messages and for the name of a nameless body
/// @throws InputError for a plane's normal or a capsule's axis of no length
Body make_body(const BodyScene& body_scene, const Scene& scene, int index);

/// Makes a body from a mesh (shape = mesh or mannequin): scales it, turns it about x, then y, then z, and shifts it
/// by `center`. A closed mesh whose faces are all wound clockwise is turned inside out.
/// @param loaded  the mesh in metres, z up
/// @throws InputError if the mesh has no faces, or a face names a vertex that does not exist
Body make_body(const BodyScene& body_scene, const Scene& scene, int index, const TriangleMesh& loaded);

/// A pose that a body passes through: vertices as loaded, [m], z up.
struct LoadedPose {
    double time = 0;  ///< [s], > 0
    std::vector<Vec3> vertices;
    bool smooth = false;
};

/// Gives a body the motion of its keyframes and poses, if there is any.
/// @param poses  in the order of their times, placed as the body's mesh is
void add_motion(Body& body, const BodyScene& body_scene, std::vector<LoadedPose> poses);

}  // namespace selvage
