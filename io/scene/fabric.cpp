#include "io/scene/fabric.hpp"

#include <cmath>

namespace selvage {

double twist_rigidity(const Fabric& fabric)
{
    if (!std::isnan(fabric.bending_twist)) return fabric.bending_twist;
    return 2 * (std::sqrt(fabric.bending_weft * fabric.bending_warp) - fabric.bending_coupling);
}

bool has_curves(const Fabric& fabric)
{
    return fabric.stretch_limit > 0 || fabric.shear_limit > 0 || !fabric.stretch_weft_curve.empty() ||
           !fabric.stretch_warp_curve.empty() || !fabric.shear_curve.empty();
}

std::array<StressCurve, 3> membrane_curves(const Fabric& fabric)
{
    const auto curve = [&](const StressCurve& given, double slope, double limit) {
        const StressCurve whole = given.empty() ? straight_curve(slope) : given;
        return limit > 0 ? limited_curve(whole, limit, fabric.stretch_limit_factor) : whole;
    };
    const double stretch = membrane_point(CurveMeasure::tension, {fabric.stretch_limit, 0}).x();
    const double shear = membrane_point(CurveMeasure::shear, {fabric.shear_limit, 0}).x();
    return {curve(fabric.stretch_weft_curve, fabric.stretch_weft, stretch),
            curve(fabric.stretch_warp_curve, fabric.stretch_warp, stretch),
            curve(fabric.shear_curve, fabric.shear, shear)};
}

}  // namespace selvage
