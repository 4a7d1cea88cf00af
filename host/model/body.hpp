#pragma once
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "host/model/body_motion.hpp"
#include "io/geometry.hpp"

namespace selvage {

/// An obstacle for the cloth, in the scene's frame and as it is at time 0.
struct Body {
    enum class Kind { mesh, sphere, plane, capsule };

    std::string name;
    Kind kind = Kind::mesh;
    TriangleMesh mesh;            ///< The surface [m]; for the other kinds a tessellation for files and pictures.
    Vec3 center = Vec3::Zero();   ///< Centre (sphere), a point (plane), first end (capsule) [m].
    Vec3 end = Vec3::UnitZ();     ///< Second end (capsule) [m].
    Vec3 normal = Vec3::UnitZ();  ///< Unit normal out of the body (plane).
    double radius = 0;            ///< Sphere, capsule [m].
    double friction = std::numeric_limits<double>::quiet_NaN();  ///< Coulomb coefficient; NaN: the fabric's.
    std::shared_ptr<const BodyMotion> motion;                    ///< Null: it stands still.
};

/// Returns the surface of a body at a time [s].
TriangleMesh body_mesh_at(const Body& body, double time);

/// True if any of the bodies moves.
bool any_moves(const std::vector<Body>& bodies);

/// A pose that a body passes through.
struct LoadedPose {
    double time = 0;             ///< [s], > 0
    std::vector<Vec3> vertices;  ///< As loaded, z up [m].
    bool smooth = false;         ///< See MeshPose.
};

}  // namespace selvage
