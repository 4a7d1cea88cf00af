#include "host/render/shading.hpp"

#include <algorithm>
#include <cmath>

namespace selvage {
namespace {

// Linear colours of the lights and bodies; a white surface in full key light has about 1. All numbers of this file were
// chosen by eye.
const Vec3f key_colour(1.22f, 1.12f, 0.98f);
const Vec3f fill_colour(0.07f, 0.08f, 0.10f);
const Vec3f zenith_colour(0.46f, 0.50f, 0.56f);
const Vec3f horizon_colour(0.28f, 0.285f, 0.30f);
const Vec3f floor_colour(0.17f, 0.155f, 0.14f);
const Vec3f body_colour(0.60f, 0.54f, 0.47f);
constexpr float key_radius = 0.22f;  // tangent of the key light's angular radius

constexpr float stitch_offset = 4.5f;  // of a seam's top stitching, in line widths
constexpr float hem_offset = 8.f;      // of a hem's stitching, in line widths

float smooth_step(float low, float high, float value)
{
    const float t = std::clamp((value - low) / (high - low), 0.f, 1.f);
    return t * t * (3 - 2 * t);
}

// Returns 1 on a line of the given half width and 0 at a distance from it, with a smooth transition.
float line_strength(float distance, float half_width)
{
    return 1 - smooth_step(0.5f * half_width, 1.5f * half_width, std::abs(distance));
}

Vec3f mixed(const Vec3f& a, const Vec3f& b, float share_of_b) { return a + share_of_b * (b - a); }

}  // namespace

float line_reach(float line_width) { return (hem_offset + 1) * line_width; }

Studio::Studio(const PictureScene& scene, const SceneTracer& tracer, const Camera& camera)
    : scene_(scene), tracer_(tracer)
{
    const Vec3f ahead = Vec3f(camera.forward.x(), camera.forward.y(), 0).normalized();
    to_key_ = (-0.62f * ahead - 0.72f * camera.right + 0.78f * Vec3f::UnitZ()).normalized();
    to_fill_ = (0.15f * ahead + 0.95f * camera.right + 0.25f * Vec3f::UnitZ()).normalized();
}

Vec3f Studio::sky_colour(const Vec3f& direction) const
{
    const float z = direction.z();
    return z > 0 ? mixed(horizon_colour, zenith_colour, std::sqrt(z))
                 : mixed(horizon_colour, floor_colour, std::sqrt(-z));
}

Vec3f Studio::cloth_colour(const SurfaceHit& hit) const
{
    const ClothLook& look = scene_.cloth;
    Vec3f colour = look.face_colours[std::size_t(hit.face)];
    // The reverse of a dyed fabric is paler and greyer.
    if (hit.back_side) colour = mixed(colour, Vec3f::Constant(colour.mean() + 0.08f), 0.45f);
    const float half_width = look.line_width / 2;
    const float seam = look.seams.distance(hit.face, hit.position);
    const float hem = look.hems.distance(hit.face, hit.position);
    colour *= 1 - 0.72f * line_strength(seam, 1.2f * half_width);
    colour *= 1 - 0.22f * line_strength(seam - stitch_offset * look.line_width, 0.7f * half_width);
    colour *= 1 - 0.30f * line_strength(hem, 1.2f * half_width);
    colour *= 1 - 0.26f * line_strength(hem - hem_offset * look.line_width, 0.8f * half_width);
    return colour;
}

Appearance Studio::surface(const Ray& ray, const SurfaceHit& hit, DiscPoint choice) const
{
    const bool is_cloth = hit.mesh == 0;
    const Vec3f albedo = is_cloth ? cloth_colour(hit) : body_colour;

    Vec3f light = Vec3f::Zero();
    const Vec3f to_key = direction_in_cone(to_key_, key_radius, choice);
    const float key_cosine = hit.normal.dot(to_key);
    if (key_cosine > 0 && !tracer_.is_blocked({hit.light_origin, to_key})) light += key_cosine * key_colour;

    const Vec3f to_sky = cosine_direction(hit.normal, choice);
    const bool sky_blocked = to_sky.dot(hit.face_normal) <= 0 || tracer_.is_blocked({hit.light_origin, to_sky});
    // Where the sky is blocked, its light is replaced by an estimate of the light reflected by the blocking surface,
    // which is assumed to have the same colour.
    light += sky_blocked ? Vec3f(0.30f * albedo.cwiseProduct(horizon_colour)) : sky_colour(to_sky);
    light += (sky_blocked ? 0.15f : 1.f) * std::max(0.f, hit.normal.dot(to_fill_)) * fill_colour;

    // Fibres that stand up from the surface catch light at grazing angles.
    const float grazing = std::pow(1 - std::clamp(-hit.normal.dot(ray.direction), 0.f, 1.f), 3.f);
    const float sheen = (is_cloth ? 0.30f : 0.06f) * grazing;
    return {albedo + sheen * mixed(albedo, Vec3f::Constant(0.6f), 0.5f), light};
}

Vec3f Studio::backdrop_colour(float height) const
{
    static const Vec3f low(0.70f, 0.68f, 0.65f), high(0.90f, 0.89f, 0.87f);
    return mixed(low, high, smooth_step(0, 1, height));
}

float Studio::ground_fade(const Vec3f& point) const
{
    return 1 - smooth_step(1.f, 2.2f, point.head<2>().norm() / scene_.radius);
}

std::optional<Vec3f> Studio::ground_point(const Ray& ray) const
{
    if (!scene_.has_ground || ray.direction.z() >= 0) return std::nullopt;
    const float distance = (scene_.ground_height - ray.origin.z()) / ray.direction.z();
    if (distance <= 0) return std::nullopt;
    const Vec3f point = ray.origin + distance * ray.direction;
    return ground_fade(point) > 0 ? std::optional(point) : std::nullopt;
}

float Studio::ground_light(const Vec3f& point, DiscPoint choice) const
{
    const bool key_blocked = tracer_.is_blocked({point, direction_in_cone(to_key_, 1.4f * key_radius, choice)});
    const bool sky_blocked = tracer_.is_blocked({point, cosine_direction(Vec3f::UnitZ(), choice)});
    return 1 - ground_fade(point) * (0.38f * float(key_blocked) + 0.42f * float(sky_blocked));
}

}  // namespace selvage
