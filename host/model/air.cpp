#include "host/model/air.hpp"

#include <cmath>
#include <numbers>

namespace selvage {
namespace {

// Waves in each direction, from the slowest to eight times as fast: a step of a run does not see faster ones, and with
// fewer the gusts repeat to the eye. Chosen by looking at `builtin:flag`.
constexpr int waves_per_axis = 12;
constexpr double octaves = 3;

// The finaliser of SplitMix64: numbers in [0, 1) that follow from seed and index alone.
double mixed(std::uint32_t seed, std::uint32_t index)
{
    std::uint64_t z = (std::uint64_t(seed) << 32 | index) + 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return double((z ^ (z >> 31)) >> 11) * 0x1p-53;
}

}  // namespace

// Energy per octave falls as frequency^(-2/3), as Kolmogorov's turbulence has it. A wave of amplitude a has the
// variance a^2/2.
Air::Air(const Vec3& mean, double strength, double period, std::uint32_t seed) : mean_(mean)
{
    if (strength == 0) return;
    for (int axis = 0; axis < 3; ++axis) {
        double variance = 0;
        for (int k = 0; k < waves_per_axis; ++k) {
            const auto index = std::uint32_t(2 * (waves_per_axis * axis + k));
            const double times = std::pow(2, octaves * (k + mixed(seed, index)) / waves_per_axis);
            const double turn = 2 * std::numbers::pi;
            waves_[axis].push_back({std::pow(times, -1.0 / 3), turn * times / period, turn * mixed(seed, index + 1)});
            variance += 0.5 * waves_[axis].back().amplitude * waves_[axis].back().amplitude;
        }
        for (Wave& wave : waves_[axis]) wave.amplitude *= strength / std::sqrt(variance);
    }
}

Vec3 Air::velocity(double time) const
{
    Vec3 velocity = mean_;
    for (int axis = 0; axis < 3; ++axis)
        for (const Wave& wave : waves_[axis])
            velocity[axis] += wave.amplitude * std::cos(wave.frequency * time + wave.phase);
    return velocity;
}

}  // namespace selvage
