#pragma once
#include <vector>

namespace selvage {

/// A cross-section of a SectionTube: an ellipse whose two halves may differ in depth. All lengths in [m].
struct TubeStation {
    double t = 0;                       ///< Place along the axis.
    double centre_u = 0, centre_v = 0;  ///< Offset of the section's centre from the axis.
    double radius_u = 0;
    double radius_low = 0;   ///< Radius towards -v.
    double radius_high = 0;  ///< Radius towards +v.
};

/// A limb as an implicit shape: elliptical sections, interpolated along the axis by monotone cubics
/// (Fritsch and Carlson 1980) that are then blurred a little, closed at both ends by half ellipsoids.
class SectionTube {
public:
    SectionTube() = default;

    /// @param stations  at least two, t strictly increasing
    /// @param cap_first, cap_last  lengths of the end caps beyond the first and last station [m], > 0
    SectionTube(const std::vector<TubeStation>& stations, double cap_first, double cap_last);

    /// First-order signed distance [m] at the point (t, u, v) of the tube's frame, negative inside:
    /// k0 (k0 - 1) / k1 with k0 = |p / r|, k1 = |p / r^2| for the section's radii r.
    double distance(double t, double u, double v) const;

    /// Section at t, clamped to the ends.
    TubeStation section(double t) const;

private:
    std::vector<TubeStation> table_;  ///< Uniform in t.
    double first_ = 0, last_ = 0, per_length_ = 0;
    double cap_first_ = 0, cap_last_ = 0;
};

}  // namespace selvage
