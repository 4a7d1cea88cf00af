#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "io/geometry.hpp"

namespace selvage {

/// How the air around the cloth moves: a mean velocity, and gusts that are the same for the same seed whatever the
/// steps of a run. Gusts in the open are larger than any cloth, so all air has one velocity at a time.
class Air {
public:
    /// @param strength  standard deviation of each component of the gusts [m/s]; 0: steady air
    /// @param period    of the slowest and strongest waves that they are made of [s], > 0
    Air(const Vec3& mean, double strength, double period, std::uint32_t seed);

    Vec3 velocity(double time) const;  ///< At a time [s] in m/s.

private:
    struct Wave {
        double amplitude, frequency, phase;  ///< [m/s], [rad/s], [rad]
    };
    Vec3 mean_;
    std::array<std::vector<Wave>, 3> waves_;  ///< Along x, y and z.
};

}  // namespace selvage
