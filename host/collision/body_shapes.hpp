#pragma once
#include <string>

#include "io/scene.hpp"

namespace selvage {

/// A rigid obstacle for the cloth, in the scene's frame.
struct Body {
    enum class Kind { mesh, sphere, plane, capsule };

    std::string name;
    Kind kind = Kind::mesh;
    TriangleMesh mesh;              ///< The surface [m]; for the other kinds a tessellation for files and pictures.
    Vec3 center = Vec3::Zero();     ///< Centre (sphere), a point (plane), first end (capsule) [m].
    Vec3 end = Vec3::UnitZ();       ///< Second end (capsule) [m].
    Vec3 normal = Vec3::UnitZ();    ///< Unit normal out of the body (plane).
    double radius = 0;              ///< Sphere, capsule [m].
    double friction = automatic;    ///< Coulomb coefficient; NaN: the fabric's.
};

/// Makes a body of a shape that needs no file: sphere, plane (drawn as a square, infinite for contact), capsule,
/// cylinder (upright, `center` in the middle of its axis; a closed mesh).
/// @param index  position in Scene::bodies, for messages and for the name of a nameless body
/// @throws InputError for a plane's normal or a capsule's axis of no length
Body make_body(const BodyScene& body_scene, const Scene& scene, int index);

/// Makes a body from a mesh (shape = mesh or mannequin): scales it, turns it about x, then y, then z, and shifts it
/// by `center`. A closed mesh whose faces are all wound clockwise is turned inside out.
/// @param loaded  the mesh in metres, z up
/// @throws InputError if the mesh has no faces, or a face names a vertex that does not exist
Body make_body(const BodyScene& body_scene, const Scene& scene, int index, const TriangleMesh& loaded);

}  // namespace selvage
