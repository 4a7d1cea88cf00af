#include "host/render/view.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <vector>

#include <tbb/blocked_range2d.h>
#include <tbb/parallel_for.h>

#include "host/render/sampling.hpp"

namespace selvage {
namespace {

constexpr int scout_rays = 4;    // a pixel takes no more rays if all of these miss the subject
constexpr float border = 0.12f;  // part of a view's width over which shadows fade towards its sides; chosen by eye
constexpr int tile = 32;         // size of a task [pixels]; chosen by hand, not measured
constexpr float same_surface_cosine = 0.8f;  // between normals within one pixel, else it shows a fold; chosen by eye

struct UnitSquare {
    float x, y;
};

// Returns a grid of sample positions, the four corners first, since they are the scout rays.
std::vector<UnitSquare> places_in_pixel(int samples_per_axis)
{
    std::vector<UnitSquare> corners, others;
    const int last = samples_per_axis - 1;
    const auto middle = [&](int cell) { return (float(cell) + 0.5f) / float(samples_per_axis); };
    for (int row = 0; row <= last; ++row)
        for (int column = 0; column <= last; ++column) {
            const bool is_corner = (row == 0 || row == last) && (column == 0 || column == last);
            (is_corner ? corners : others).push_back({middle(column), middle(row)});
        }
    corners.insert(corners.end(), others.begin(), others.end());
    return corners;
}

// Returns false if `stop` has broken it off.
template <class Visit>
bool for_every_pixel(int width, int height, const std::function<bool()>& stop, const Visit& visit)
{
    std::atomic<bool> stopped{false};
    const tbb::blocked_range2d<int> all(0, height, tile, 0, width, tile);
    tbb::parallel_for(all, [&](const auto& range) {
        for (int row = range.rows().begin(); row < range.rows().end(); ++row)
            for (int column = range.cols().begin(); column < range.cols().end(); ++column) {
                if (stopped || (stop && stop())) {
                    stopped = true;
                    return;
                }
                visit(column, row);
            }
    });
    return !stopped;
}

float display_value(float linear)
{
    // Values above the shoulder approach white smoothly. The transfer function of sRGB (IEC 61966-2-1) follows.
    constexpr float shoulder = 0.62f;
    const float above = (linear - shoulder) / (1 - shoulder);
    const float toned = above > 0 ? shoulder + (1 - shoulder) * (1 - std::exp(-above)) : std::max(linear, 0.f);
    return toned <= 0.0031308f ? 12.92f * toned : 1.055f * std::pow(toned, 1 / 2.4f) - 0.055f;
}

// Dithers: rounds up or down at random, so that smooth gradients show no bands.
Rgb quantised(const Vec3f& colour, int column, int row)
{
    std::uint32_t bits = mixed_bits(std::uint32_t(column) * 0x9e3779b9u + std::uint32_t(row));
    Rgb rgb;
    for (int channel = 0; channel < 3; ++channel) {
        bits = mixed_bits(bits + 1);
        const float chance = float(bits >> 8) * 0x1p-24f;
        rgb[std::size_t(channel)] = std::uint8_t(std::clamp(255 * display_value(colour[channel]) + chance, 0.f, 255.f));
    }
    return rgb;
}

class ViewTracer {
public:
    ViewTracer(const PictureScene& scene, const SceneTracer& tracer, const Camera& camera, int samples_per_axis,
               int width, int height)
        : tracer_(tracer), camera_(camera), studio_(scene, tracer, camera), width_(width), height_(height),
          places_(places_in_pixel(samples_per_axis)), samples_(samples_per_axis * samples_per_axis)
    {
    }

    Pixel pixel(int column, int row) const
    {
        Pixel pixel;
        const int count = int(places_.size());
        for (int sample = 0; sample < count; ++sample) {
            const bool missed = pixel.subject == Pixel::backdrop || pixel.subject == Pixel::ground;
            if (sample == scout_rays && missed) return averaged(pixel, scout_rays);
            add_sample(column, row, sample, pixel);
        }
        return averaged(pixel, count);
    }

private:
    static Pixel averaged(Pixel pixel, int count)
    {
        pixel.colour /= float(count);
        pixel.reflectance /= float(count);
        pixel.light /= float(count);
        return pixel;
    }

    void add_sample(int column, int row, int sample, Pixel& pixel) const
    {
        const UnitSquare& place = places_[std::size_t(sample)];
        const float x = (float(column) + place.x) / float(width_), y = (float(row) + place.y) / float(height_);
        const Ray ray{camera_.origin, camera_.direction(2 * x - 1, 1 - 2 * y)};
        const DiscPoint& choice = samples_.at(column, row, sample);

        int subject = Pixel::backdrop;
        Vec3f normal = Vec3f::UnitZ(), position = Vec3f::Zero();
        Appearance seen{studio_.backdrop_colour(1 - y), Vec3f::Ones()};
        if (const auto hit = tracer_.first_hit(ray)) {
            subject = hit->mesh;
            normal = hit->normal;
            position = hit->position;
            seen = studio_.surface(ray, *hit, choice);
        } else if (const auto ground = studio_.ground_point(ray)) {
            subject = Pixel::ground;
            position = *ground;
            const float inwards = std::min({x, 1 - x, border}) / border;
            seen.light = Vec3f::Constant(1 - inwards * (1 - studio_.ground_light(*ground, choice)));
        }
        if (sample == 0) {
            pixel.subject = subject;
            pixel.normal = normal;
            pixel.position = position;
        } else if (subject != pixel.subject || normal.dot(pixel.normal) < same_surface_cosine) {
            pixel.subject = Pixel::mixed;
        }
        pixel.colour += seen.reflectance.cwiseProduct(seen.light);
        pixel.reflectance += seen.reflectance;
        pixel.light += seen.light;
    }

    const SceneTracer& tracer_;
    const Camera& camera_;
    Studio studio_;
    int width_, height_;
    std::vector<UnitSquare> places_;
    InterleavedSamples samples_;
};

}  // namespace

bool draw_view(const PictureScene& scene, const SceneTracer& tracer, const Camera& camera, int samples_per_axis,
               const std::function<bool()>& stop, int first_column, int width, Image& image)
{
    const ViewTracer view(scene, tracer, camera, samples_per_axis, width, image.height);
    PixelBuffer buffer(width, image.height);
    if (!for_every_pixel(width, image.height, stop,
                         [&](int column, int row) { buffer.at(column, row) = view.pixel(column, row); }))
        return false;

    const float pixel_size = camera.pixel_size(width);
    return for_every_pixel(width, image.height, stop, [&](int column, int row) {
        image.at(first_column + column, row) = quantised(smoothed_colour(buffer, column, row, pixel_size), column, row);
    });
}

}  // namespace selvage
