#pragma once
#include <array>
#include <limits>
#include <string>
#include <vector>

#include "io/scene/stress_curve.hpp"

namespace selvage {

/// A fabric's mechanical properties per unit width or area, as measured on the cloth, SI units.
/// Stress in the membrane (second Piola-Kirchhoff, weft u and warp v, Green-Lagrange strain e):
///     s_uu = weft e_uu + coupling e_vv,  s_vv = warp e_vv + coupling e_uu,  s_uv = shear g,  g = 2 e_uv = U.V,
/// where weft e_uu, warp e_vv and shear g are replaced by a curve where the fabric has one.
struct Fabric {
    std::string name;
    double areal_density = 0.15;       ///< [kg/m^2]
    double thickness = 0.0003;         ///< [m]
    double stretch_weft = 300;         ///< Membrane stiffness along weft [N/m].
    double stretch_warp = 300;         ///< Membrane stiffness along warp [N/m].
    double stretch_coupling = 0;       ///< Coupling of weft and warp [N/m]; its square is below weft * warp.
    double shear = 40;                 ///< Shear stiffness [N/m] per radian of shear angle.
    double stretch_limit = 0;          ///< Elongation beyond which the cloth stiffens [1]; 0: none.
    double shear_limit = 0;            ///< Shear angle beyond which the cloth stiffens [rad]; 0: none.
    double stretch_limit_factor = 20;  ///< Multiplies the slope of a curve beyond its limit [1].
    double bending_weft = 1e-5;   ///< Bending rigidity when bent along weft [N m], as KES-FB2 or ASTM D1388 measure it.
    double bending_warp = 1e-5;   ///< Bending rigidity when bent along warp [N m].
    double bending_coupling = 0;  ///< Couples both curvatures [N m]; its square is below weft * warp.
    double bending_twist =
        std::numeric_limits<double>::quiet_NaN();  ///< Moment per twist [N m]; NaN: see twist_rigidity.
    double hysteresis_weft =
        0;  ///< Width 2HB of the moment loop when bent along weft and back [N], as KES-FB2; 0: none.
    double hysteresis_warp = 0;      ///< The same along warp [N].
    double friction = 0.3;           ///< Coulomb coefficient against a body [1].
    double damping = 0.5;            ///< Viscous drag per unit mass [1/s].
    StressCurve stretch_weft_curve;  ///< Empty: straight, with slope stretch_weft; else that is its slope at 0.
    StressCurve stretch_warp_curve;  ///< Likewise.
    StressCurve shear_curve;         ///< Likewise.
    std::string source;              ///< Where the values come from, as shown to the user.
};

/// Moment per twist d2z/dxdy [N m]: as given, or 2 (sqrt(weft warp) - coupling), which makes equal rigidities
/// isotropic.
double twist_rigidity(const Fabric& fabric);

/// Tells whether the membrane is other than straight in any direction.
bool has_curves(const Fabric& fabric);

/// Returns the weft, warp and shear curve of the membrane, limits included.
std::array<StressCurve, 3> membrane_curves(const Fabric& fabric);

}  // namespace selvage
