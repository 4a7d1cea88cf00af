#pragma once
#include "host/model/body.hpp"
#include "io/scene/scene.hpp"

namespace selvage {

/// Makes a body of a shape that needs no file: sphere, plane (drawn as a square, infinite for contact), capsule,
/// cylinder, cone (both upright, closed meshes; `center` in the middle of the cylinder's axis, of the cone's base),
/// torus (a mesh about `center`, its axis `normal`).
/// @param index  position in Scene::bodies, for messages and for the name of a nameless body
/// @throws InputError for a plane's normal or a capsule's axis of no length
Body make_body(const BodyScene& body_scene, const Scene& scene, int index);

/// Makes a body from a mesh (shape = mesh or mannequin): turns it about x, then y, then z, and shifts it by `center`.
/// @param loaded  the mesh in metres, z up, in the size that it has in the scene
/// @throws InputError if the mesh has no faces, or a face names a vertex that does not exist
Body make_body(const BodyScene& body_scene, const Scene& scene, int index, const TriangleMesh& loaded);

/// Gives a body the motion of its keyframes and poses, if there is any.
/// @param poses  in the order of their times, placed as the body's mesh is
void add_motion(Body& body, const BodyScene& body_scene, std::vector<LoadedPose> poses);

}  // namespace selvage
