#pragma once
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "host/render/drawn_mesh.hpp"
#include "host/render/embree.hpp"

namespace selvage {

struct Ray {
    Vec3f origin, direction;
};

/// What a ray meets first. Normals face the ray's origin.
struct SurfaceHit {
    int mesh = 0, face = 0;     ///< Index in the order given, and of DrawnMesh::faces.
    float distance = 0;         ///< Along the ray [m].
    bool back_side = false;     ///< The face's right-handed normal points away from the ray's origin.
    Vec3f position;             ///< On the flat face [m].
    Vec3f face_normal, normal;  ///< Unit; of the flat face and interpolated.
    /// Start of rays towards lights: the point lifted to the smooth surface that the flat faces approximate, so that
    /// coarse meshes show no facets where the light begins to graze (Hanika 2021, Hacking the shadow terminator, Ray
    /// Tracing Gems II, chapter 4).
    Vec3f light_origin;
};

/// Traces rays against drawn meshes with Embree.
class SceneTracer {
public:
    /// @param meshes  outlive this object
    /// @throws std::runtime_error if Embree fails.
    explicit SceneTracer(std::vector<const DrawnMesh*> meshes);

    /// Returns the nearest surface along a ray.
    std::optional<SurfaceHit> first_hit(const Ray& ray) const;
    /// Returns whether anything lies along a ray.
    bool is_blocked(const Ray& ray) const;

private:
    std::vector<const DrawnMesh*> meshes_;
    EmbreeDevice device_;
    EmbreeScene scene_;
    float lift_ = 0;  // distance of a new ray's start from the surface [m]
};

}  // namespace selvage
