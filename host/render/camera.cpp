#include "host/render/camera.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>

namespace selvage {
namespace {

constexpr float long_lens = 0.15f;  // tangent of half the larger field of view: about 17 degrees in all; chosen by eye
constexpr float smallest_subject = 1e-3f;  // least extent of a subject [m], so that a point has a view too

Camera oriented(ViewDirection direction)
{
    const float cos_azimuth = std::cos(direction.azimuth), sin_azimuth = std::sin(direction.azimuth);
    Camera camera;
    camera.right = {cos_azimuth, sin_azimuth, 0};
    camera.forward = Vec3f(-sin_azimuth, cos_azimuth, 0) * std::cos(direction.elevation) -
                     Vec3f::UnitZ() * std::sin(direction.elevation);
    camera.up = camera.right.cross(camera.forward);
    return camera;
}

// The two planes through the camera that bound one screen axis: point . axis - tangent * (point . forward) is at
// most `high`, and with the axis reversed at most `low`.
struct Slab {
    float low = -std::numeric_limits<float>::infinity(), high = low;

    float depth(float tangent) const { return -(low + high) / (2 * tangent); }
    float middle() const { return (high - low) / 2; }
};

Slab bounding_slab(std::span<const Vec3f> points, const Vec3f& axis, const Vec3f& forward, float tangent)
{
    Slab slab;
    for (const Vec3f& point : points) {
        const float across = point.dot(axis), nearer = -tangent * point.dot(forward);
        slab.high = std::max(slab.high, across + nearer);
        slab.low = std::max(slab.low, -across + nearer);
    }
    return slab;
}

}  // namespace

float outline_aspect(std::span<const Vec3f> points, ViewDirection direction)
{
    const Camera camera = oriented(direction);
    const Slab across = bounding_slab(points, camera.right, camera.forward, 0);
    const Slab upright = bounding_slab(points, camera.up, camera.forward, 0);
    return (upright.low + upright.high + smallest_subject) / (across.low + across.high + smallest_subject);
}

Camera frame_points(std::span<const Vec3f> points, ViewDirection direction, float aspect, float margin)
{
    Camera camera = oriented(direction);
    camera.half_width = aspect > 1 ? long_lens / aspect : long_lens;
    camera.half_height = camera.half_width * aspect;
    const float tangent_x = camera.half_width * (1 - 2 * margin), tangent_y = camera.half_height * (1 - 2 * margin);
    const Slab across = bounding_slab(points, camera.right, camera.forward, tangent_x);
    const Slab upright = bounding_slab(points, camera.up, camera.forward, tangent_y);
    const float depth = std::min(across.depth(tangent_x), upright.depth(tangent_y)) - smallest_subject / long_lens;
    camera.origin = across.middle() * camera.right + upright.middle() * camera.up + depth * camera.forward;

    const Slab along = bounding_slab(points, camera.forward, camera.forward, 0);
    camera.subject_depth = along.middle() - depth;
    return camera;
}

}  // namespace selvage
