#pragma once
#include <optional>
#include <vector>

#include "host/render/camera.hpp"
#include "host/render/line_marks.hpp"
#include "host/render/sampling.hpp"
#include "host/render/scene_tracer.hpp"

namespace selvage {

/// The colours of the cloth and the lines drawn on it.
struct ClothLook {
    std::vector<Vec3f> face_colours;  ///< Linear reflectance of each drawn face.
    LineMarks seams, hems;
    float line_width = 0;  ///< Of a seam's stitching [m].
};

/// What stands in the picture. Mesh 0 is the cloth, the rest are bodies.
struct PictureScene {
    std::vector<DrawnMesh> meshes;
    ClothLook cloth;
    bool has_ground = false;
    float ground_height = 0;  ///< [m]
    float radius = 0;         ///< Of the framed points, about the origin [m].
};

/// How a point looks: linear colour is reflectance times light.
struct Appearance {
    Vec3f reflectance, light;
};

/// Returns the distance from a seam or hem within which shading looks for lines [m].
float line_reach(float line_width);

/// Lights a scene as seen by one camera: a soft key light from the upper left of the camera, a sky that fills the
/// shade, and a backdrop without a horizon that only catches shadows.
class Studio {
public:
    /// Every argument outlives this object.
    Studio(const PictureScene& scene, const SceneTracer& tracer, const Camera& camera);

    /// Returns the appearance of a surface along a ray.
    /// @param choice  picks the points of the key light and of the sky that are tested for visibility
    Appearance surface(const Ray& ray, const SurfaceHit& hit, DiscPoint choice) const;
    /// Returns linear colour of the backdrop.
    /// @param height  0 at the bottom of the picture, 1 at the top
    Vec3f backdrop_colour(float height) const;
    /// Returns the point where a ray meets the ground close enough to the subject for its shadow to show.
    std::optional<Vec3f> ground_point(const Ray& ray) const;
    /// Returns the share of the light that reaches the ground past the subject, from 0 to 1.
    float ground_light(const Vec3f& point, DiscPoint choice) const;

private:
    Vec3f sky_colour(const Vec3f& direction) const;
    Vec3f cloth_colour(const SurfaceHit& hit) const;
    float ground_fade(const Vec3f& point) const;

    const PictureScene& scene_;
    const SceneTracer& tracer_;
    Vec3f to_key_, to_fill_;
};

}  // namespace selvage
