#pragma once
#include <vector>

#include "io/geometry.hpp"

namespace selvage {

/// One range of a stress curve: for d = e - start >= 0,
///     s = stress + slope d + quadratic d^2 + cubic d^3      [N/m]
/// where e is the Green-Lagrange strain (of the weft or the warp) or g = U.V (shear), and s is the second
/// Piola-Kirchhoff stress per width.
struct CurveRange {
    double start = 0;      ///< [1]
    double stress = 0;     ///< At `start` [N/m].
    double slope = 0;      ///< At `start` [N/m].
    double quadratic = 0;  ///< [N/m]
    double cubic = 0;      ///< [N/m]
};

/// Ranges in the order of strain, the first of which starts at no strain and no stress; the last one has no end.
/// Below zero a curve goes on with its slope at zero (weft and warp) or is odd (shear).
using StressCurve = std::vector<CurveRange>;

/// Largest number of measured points of a curve, the origin not counted.
constexpr int most_curve_points = 8;

/// How measured strain and stress are defined.
enum class CurveMeasure {
    tension,  ///< Elongation over length [1], and force over unstretched width [N/m] (KES-FB1, grab and strip tests).
    shear     ///< Shear angle phi [rad], and shear force over length [N/m] (KES-FB1, picture frame).
};

/// Turns a measured point into the strain and stress of the membrane.
///     tension:  e = x + x^2/2,   s = P / (1 + x)       (P is the nominal stress: W = int P dx = int s de)
///     shear:    g = sin(phi),    s = F                 (yarns keep their length: a point of a yarn of unit length
///     moves
///                                                       by d(sin phi) along F, so W = int F dg)
Vec2 membrane_point(CurveMeasure measure, const Vec2& measured);

/// The inverse of membrane_point.
Vec2 measured_point(CurveMeasure measure, const Vec2& point);

/// A straight line through the origin. @param slope [N/m]
StressCurve straight_curve(double slope);

/// Straight between the points and through the origin; the last range goes on.
/// @param points  strain [1] and stress [N/m] of the membrane, both increasing from above 0
StressCurve piecewise_curve(const std::vector<Vec2>& points);

/// The monotone cubic Hermite interpolation of the origin and the points, then its tangent. Slopes at inner points are
/// the weighted harmonic means of Fritsch and Butland 1984; those at the ends come from three points and are kept
/// between a quarter and three times the slope of the outermost chord, so that stress rises everywhere.
StressCurve smooth_curve(const std::vector<Vec2>& points);

/// s = k1 e + k2 e^2 + k3 e^3 (Volino, Magnenat-Thalmann and Faure 2009, section 4).
StressCurve cubic_curve(double k1, double k2, double k3);

/// Returns the curve with a steep straight range that starts at `limit`: its slope is `factor` times the one there.
StressCurve limited_curve(const StressCurve& curve, double limit, double factor);

/// Stress at a strain >= 0 [N/m].
double curve_stress(const StressCurve& curve, double strain);

/// Slope at a strain >= 0 [N/m].
double curve_slope(const StressCurve& curve, double strain);

/// The smallest slope anywhere at or above strain 0 [N/m].
double smallest_slope(const StressCurve& curve);

/// Energy per area at the start of every range: the integral of stress from 0 [J/m^2].
std::vector<double> start_energies(const StressCurve& curve);

}  // namespace selvage
