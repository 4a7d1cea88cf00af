#include "host/body/shoulders.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "host/body/bend.hpp"

namespace selvage {
namespace {

struct NeckLimits {                                                // over the height
    static constexpr double axis_half = 0.012;                     // half the piece of the neck that gives its axis
    static constexpr double search_down = 0.02, search_up = 0.02;  // of the shortest tape along the axis
    static constexpr double search_step = 0.0025;
    static constexpr double radius = 0.075;      // of all that a plane through the neck may meet
    static constexpr double base_radius = 0.11;  // the same for its base
    static constexpr double steepest = 0.6;      // tangent of the axis from the upright: more is no neck but a chin
    static constexpr double profile_step = 0.0015;
};

// Faces of the trunk near the neck's middle, seen from above.
FaceMask faces_near(const Anatomy& body, const Vec3& middle, double radius)
{
    FaceMask mask = body.trunk;
    for (std::size_t f = 0; f < mask.size(); ++f)
        for (const int v : body.skin.faces[f])
            if ((body.at(v) - middle).head<2>().norm() > radius) mask[f] = 0;
    return mask;
}

// The highest point of a sagittal section that is not above a level.
bool top_at(const Anatomy& body, int side, double x, double below, Vec3& top)
{
    bool found = false;
    for (const Vec3& point : section(body.skin, body.halves[side], Vec3(x, 0, 0), Vec3::UnitX())) {
        if (point.z() > below || (found && point.z() <= top.z())) continue;
        top = point;
        found = true;
    }
    return found;
}

// The tops of both shoulders from the neck outwards; the bend of their mean is where they rise into the neck.
void find_sides(const Anatomy& body, double neck_level, double neck_half, const InputPlace& place, Shoulders& shoulders)
{
    const double outer = std::min(body.shoulders[0], body.shoulders[1]);
    if (outer < neck_half + 0.02 * body.height)
        throw InputError(place, "no shoulders: the arms begin no further apart than the neck is wide",
                         "a body with shoulders");
    std::vector<std::array<Vec3, 2>> profile;
    std::vector<Vec2> curve;
    const int steps = int((outer - neck_half) / (NeckLimits::profile_step * body.height));
    for (int k = 0; k <= steps; ++k) {
        const double x = neck_half + (outer - neck_half) * k / steps;
        std::array<Vec3, 2> tops;
        if (!top_at(body, 0, x, neck_level, tops[0]) || !top_at(body, 1, -x, neck_level, tops[1])) continue;
        profile.push_back(tops);
        curve.emplace_back(x, 0.5 * (tops[0].z() + tops[1].z()));
    }
    bool found = !profile.empty();
    for (int side = 0; side < 2; ++side)
        found = found &&
                top_at(body, side, (side == 0 ? 1 : -1) * body.shoulders[side], neck_level, shoulders.shoulder[side]);
    if (!found) throw InputError(place, "no shoulders above the armpits", "a body with shoulders");
    shoulders.neck_side = profile[std::max(find_bend(curve, BendSide::right).middle, 0)];
}

void find_neck(const Anatomy& body, double neck_level, Shoulders& shoulders)
{
    const double h = body.height;
    const Vec3 up = Vec3::UnitZ();
    const Tape level = tape_around(body.skin, body.trunk, Vec3(0, 0, neck_level), up);
    shoulders.neck_middle = level.middle();
    const FaceMask near = faces_near(body, shoulders.neck_middle, NeckLimits::radius * h);
    const double half = NeckLimits::axis_half * h;
    const Tape above = tape_around(body.skin, near, Vec3(0, 0, neck_level + half), up);
    const Tape below = tape_around(body.skin, near, Vec3(0, 0, neck_level - half), up);
    if (!above.points.empty() && !below.points.empty()) {
        Vec3 axis = above.middle() - below.middle();
        const double sideways = axis.head<2>().norm();
        if (sideways > NeckLimits::steepest * axis.z()) axis.head<2>() *= NeckLimits::steepest * axis.z() / sideways;
        shoulders.neck_axis = axis.normalized();
    }
    shoulders.neck = level;
    for (double t = -NeckLimits::search_down * h; t < NeckLimits::search_up * h; t += NeckLimits::search_step * h) {
        const Tape tape =
            tape_around(body.skin, near, shoulders.neck_middle + t * shoulders.neck_axis, shoulders.neck_axis);
        if (!tape.points.empty() && tape.length < shoulders.neck.length) shoulders.neck = tape;
    }
}

}  // namespace

Shoulders find_shoulders(const Anatomy& body, double neck_level, const InputPlace& place)
{
    Shoulders shoulders;
    find_neck(body, neck_level, shoulders);
    double half = 0;
    const Tape level = tape_around(body.skin, body.trunk, Vec3(0, 0, neck_level), Vec3::UnitZ());
    for (const Vec3& point : level.points) half = std::max(half, std::abs(point.x()));
    find_sides(body, neck_level, half, place, shoulders);

    const Vec3 base = 0.5 * (shoulders.neck_side[0] + shoulders.neck_side[1]);
    Vec3 across = shoulders.neck_axis;
    across.x() = 0;
    across.normalize();
    const FaceMask near = faces_near(body, base, NeckLimits::base_radius * body.height);
    std::vector<Vec3> around = section(body.skin, near, base, across);
    const std::vector<Vec3> middle = crossings(around, base, Vec3::UnitX());
    shoulders.neck_front = shoulders.neck_back = base;
    for (const Vec3& point : middle) {
        if (point.y() > shoulders.neck_back.y()) shoulders.neck_back = point;
        if (point.y() < shoulders.neck_front.y()) shoulders.neck_front = point;
    }
    std::erase_if(around, [&](const Vec3& point) {
        return point.x() > shoulders.neck_side[0].x() || point.x() < shoulders.neck_side[1].x();
    });
    shoulders.neck_base = tape_over(around, base, across);
    return shoulders;
}

}  // namespace selvage
