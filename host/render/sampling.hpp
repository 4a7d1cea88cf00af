#pragma once
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include <Eigen/Geometry>

#include "host/render/drawn_mesh.hpp"

namespace selvage {

/// A point of the unit disc.
struct DiscPoint {
    float x = 0, y = 0;
};

/// Returns well-mixed bits (the finaliser of MurmurHash3 by Appleby).
inline std::uint32_t mixed_bits(std::uint32_t bits)
{
    bits = (bits ^ (bits >> 16)) * 0x85ebca6bu;
    bits = (bits ^ (bits >> 13)) * 0xc2b2ae35u;
    return bits ^ (bits >> 16);
}

/// Evenly spread sample points of the unit disc for every pixel. The points of the pixels of a 4 x 4 block together are
/// one set that is 16 times as fine, so that averaging over any such block leaves little noise. Source: Keller and
/// Heidrich 2001, Interleaved Sampling.
class InterleavedSamples {
public:
    static constexpr int block = 4;  ///< [pixels]

    explicit InterleavedSamples(int samples_per_pixel) : samples_per_pixel_(samples_per_pixel)
    {
        for (int index = 0; index < block * block * samples_per_pixel; ++index) {
            const auto [x, y] = digital_point(std::uint32_t(index));
            const float radius = std::sqrt(x), angle = 2 * std::numbers::pi_v<float> * y;
            points_.push_back({radius * std::cos(angle), radius * std::sin(angle)});
        }
    }

    const DiscPoint& at(int column, int row, int sample) const
    {
        constexpr std::array<int, 16> phases{0, 8, 2, 10, 12, 4, 14, 6, 3, 11, 1, 9, 15, 7, 13, 5};  // ordered dither
        const int phase = phases[std::size_t((row % block) * block + column % block)];
        return points_[std::size_t(phase * samples_per_pixel_ + sample)];
    }

private:
    // Returns a point of the first two dimensions of Sobol's sequence, of which every aligned block of 2^k points has
    // exactly one point in every elementary interval of area 2^-k.
    static std::array<float, 2> digital_point(std::uint32_t index)
    {
        std::uint32_t x = 0, y = 0, direction = 1u << 31;
        for (int bit = 0; bit < 32; ++bit, direction ^= direction >> 1)
            if ((index >> bit) & 1u) {
                x |= 1u << (31 - bit);
                y ^= direction;
            }
        return {(float(x >> 8) + 0.5f) * 0x1p-24f, (float(y >> 8) + 0.5f) * 0x1p-24f};
    }

    int samples_per_pixel_;
    std::vector<DiscPoint> points_;
};

/// Returns a direction about a unit axis: uniform over the disc of the given radius at unit distance.
inline Vec3f direction_in_cone(const Vec3f& axis, float radius, DiscPoint point)
{
    const Vec3f side = axis.unitOrthogonal(), other = axis.cross(side);
    return (axis + radius * (point.x * side + point.y * other)).normalized();
}

/// Returns a direction about a unit normal with density cos / pi (Malley's method).
inline Vec3f cosine_direction(const Vec3f& normal, DiscPoint point)
{
    const Vec3f side = normal.unitOrthogonal(), other = normal.cross(side);
    const float along = std::sqrt(std::max(0.f, 1 - point.x * point.x - point.y * point.y));
    return point.x * side + point.y * other + along * normal;
}

}  // namespace selvage
