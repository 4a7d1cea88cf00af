#pragma once
#include <memory>

#include "host/collision/body_surface.hpp"
#include "host/model/body_motion.hpp"

namespace selvage {

/// The ray tracing library's device, shared by all bodies of a scene.
class EmbreeDevice {
public:
    /// @throws std::runtime_error if the library does not start
    EmbreeDevice();
    ~EmbreeDevice();
    EmbreeDevice(const EmbreeDevice&) = delete;
    EmbreeDevice& operator=(const EmbreeDevice&) = delete;
    void* handle() const { return handle_; }

private:
    void* handle_;
};

struct NearestTriangle {
    int triangle = -1;            ///< -1: none within the radius.
    double squared_distance = 0;  ///< [m^2]
};

struct SurfaceEntry {
    int triangle = -1;    ///< -1: the path enters nowhere.
    double fraction = 2;  ///< Of the path, in [0, 1].
};

/// A bounding volume hierarchy over the triangles of one body that touch a box. The hierarchy is in single precision
/// and only selects candidates. Distances and fractions are computed in double precision, with ties broken by the
/// triangle's index, so results depend neither on the hierarchy nor on hints.
class BodyBvh {
public:
    /// @param surface  must outlive this object
    /// @param deforms  the surface will change, so the hierarchy is built for fast refits
    BodyBvh(const EmbreeDevice& device, const BodySurface& surface, const Box& reach, bool deforms = false);
    ~BodyBvh();
    BodyBvh(BodyBvh&&) noexcept;
    BodyBvh& operator=(BodyBvh&&) noexcept;

    /// What so many triangles take beside the nodes of Embree's hierarchy: corners, numbers and Embree's copies
    /// [bytes].
    static std::size_t bytes_of(std::size_t triangles)
    {
        return triangles * (3 * sizeof(Vec3) + sizeof(int) + 9 * sizeof(float) + 3 * sizeof(unsigned));
    }

    /// Updates the boxes to the present vertices of the surface; the structure of the tree stays.
    void refit();

    int triangle_count() const;              ///< In the hierarchy.
    double far_radius(const Vec3& x) const;  ///< A radius around x that holds the whole body [m].

    /// Returns the triangle closest to x within the radius [m].
    /// @param hint  a triangle of an earlier answer, likely to be close still, or -1
    NearestTriangle nearest(const Vec3& x, double radius, int hint = -1) const;

    /// Returns the first triangle that the straight path x0 -> x1 passes from its outer to its inner side:
    ///     x0 + (x1 - x0) t = p0 + (p1 - p0) u + (p2 - p0) v,   0 <= t <= 1,   u, v >= 0,   u + v <= 1
    SurfaceEntry first_entry(const Vec3& x0, const Vec3& x1) const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace selvage
