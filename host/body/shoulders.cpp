#include "host/body/shoulders.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include <Eigen/Geometry>

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
    static constexpr double throat_depth = 0.05;   // below the sides of the neck, where the throat is looked for
    static constexpr double hollow_share = 0.2;    // of that depth: higher up it is no hollow but the neck itself
    static constexpr double slope_half = 0.0045;   // half the piece of the outline that gives its slope
    static constexpr double beyond_slope = 0.006;  // to the points on the sides of the neck of GarmentCode's bodies
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

// The tops of both shoulders at distances from the neck's middle, of equal steps.
struct ShoulderOutline {
    double first = 0, step = 0;             ///< [m]
    std::vector<std::array<Vec3, 2>> tops;  ///< {left, right}
    double height(int k) const { return 0.5 * (tops[k][0].z() + tops[k][1].z()); }
};

ShoulderOutline shoulder_outline(const Anatomy& body, double neck_level, double middle, double neck_half)
{
    ShoulderOutline outline{neck_half, NeckLimits::profile_step * body.height, {}};
    const double outer = std::min(body.shoulders[0], body.shoulders[1]);
    for (double x = neck_half; x < outer; x += outline.step) {
        std::array<Vec3, 2> tops;
        if (!top_at(body, 0, middle + x, neck_level, tops[0]) || !top_at(body, 1, middle - x, neck_level, tops[1]))
            break;
        outline.tops.push_back(tops);
    }
    return outline;
}

// The sides of the neck: where the mean outline, seen from the front, has turned from the neck's slope to 45 degrees,
// and a little further, since it is round there.
bool find_sides(const ShoulderOutline& outline, std::array<Vec3, 2>& sides)
{
    const int reach = std::max(1, int(NeckLimits::slope_half / NeckLimits::profile_step));
    const int beyond = int(NeckLimits::beyond_slope / NeckLimits::profile_step), count = int(outline.tops.size());
    for (int k = reach; k + std::max(reach, beyond) < count; ++k)
        if (outline.height(k - reach) - outline.height(k + reach) < 2 * reach * outline.step) {
            sides = outline.tops[k + beyond];
            return true;
        }
    return false;
}

void find_neck_and_shoulder_points(const Anatomy& body, double neck_level, double neck_half, const InputPlace& place,
                                   Shoulders& shoulders)
{
    if (std::min(body.shoulders[0], body.shoulders[1]) < neck_half + 0.02 * body.height)
        throw InputError(place, "no shoulders: the arms begin no further apart than the neck is wide",
                         "a body with shoulders");
    const ShoulderOutline outline = shoulder_outline(body, neck_level, shoulders.neck_middle.x(), neck_half);
    bool found = find_sides(outline, shoulders.neck_side);
    for (int side = 0; side < 2; ++side)
        found = found &&
                top_at(body, side, (side == 0 ? 1 : -1) * body.shoulders[side], neck_level, shoulders.shoulder[side]);
    if (!found)
        throw InputError(place,
                         "no shoulders: from the neck to the arms the outline is nowhere flatter than 45 degrees",
                         "a body with shoulders");
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

// A half of the neck's base: a plane through both sides and the point in front or at the back.
struct BasePlane {
    Vec3 middle, left, outward, up;  ///< Between the sides; unit vectors.
};

BasePlane base_plane(const Shoulders& shoulders, bool back)
{
    BasePlane plane;
    plane.middle = 0.5 * (shoulders.neck_side[0] + shoulders.neck_side[1]);
    plane.left = (shoulders.neck_side[0] - shoulders.neck_side[1]).normalized();
    const Vec3 to = (back ? shoulders.neck_back : shoulders.neck_front) - plane.middle;
    plane.outward = (to - to.dot(plane.left) * plane.left).normalized();
    plane.up = (back ? 1 : -1) * plane.left.cross(plane.outward);
    return plane;
}

Tape half_of_base(const Anatomy& body, const Shoulders& shoulders, bool back)
{
    const BasePlane plane = base_plane(shoulders, back);
    const double half = (shoulders.neck_side[0] - shoulders.neck_side[1]).norm() / 2;
    const FaceMask near = faces_near(body, plane.middle, NeckLimits::base_radius * body.height);
    std::vector<Vec3> points = section(body.skin, near, plane.middle, plane.up);
    std::erase_if(points, [&](const Vec3& point) {
        const Vec3 from = point - plane.middle;
        return from.dot(plane.outward) < 0 || std::abs(from.dot(plane.left)) > half;
    });
    if (points.empty()) return {};
    points.insert(points.end(), shoulders.neck_side.begin(), shoulders.neck_side.end());
    return tape_over(points, plane.middle, plane.up);
}

// The outline of neck and upper chest in the middle, from a level downwards.
std::vector<Vec3> throat_outline(const Anatomy& body, const std::vector<Vec3>& outline, const Vec3& level)
{
    std::vector<Vec3> front;
    for (double t = 0; t < NeckLimits::throat_depth; t += NeckLimits::profile_step) {
        const Vec3 here = level - t * body.height * Vec3::UnitZ();
        std::optional<Vec3> foremost;
        for (const Vec3& point : crossings(outline, here, Vec3::UnitZ()))
            if (point.y() < level.y() && (!foremost || point.y() < foremost->y())) foremost = point;
        if (foremost) front.push_back(*foremost);
    }
    return front;
}

// The hollow of the throat: the hindmost point, unless that is no hollow but the neck itself.
std::optional<Vec3> hollow_in(const std::vector<Vec3>& front)
{
    const auto hindmost =
        std::max_element(front.begin(), front.end(), [](const Vec3& a, const Vec3& b) { return a.y() < b.y(); });
    if (hindmost - front.begin() < std::ptrdiff_t(NeckLimits::hollow_share * double(front.size()))) return {};
    return *hindmost;
}

// In the middle of the neck: the throat below the sides, and the back at their level.
void find_throat_and_nape(const Anatomy& body, const InputPlace& place, Shoulders& shoulders)
{
    const Vec3 base = 0.5 * (shoulders.neck_side[0] + shoulders.neck_side[1]);
    const FaceMask near = faces_near(body, base, NeckLimits::base_radius * body.height);
    const std::vector<Vec3> outline = section(body.skin, near, base, Vec3::UnitX());
    const std::vector<Vec3> front = throat_outline(body, outline, base);
    shoulders.neck_back = base;
    const Tape level = tape_around(body.skin, near, base, Vec3::UnitZ());  // also over a hole of the mesh
    for (const Vec3& point : crossings(level.sides(), base, Vec3::UnitX()))
        if (point.y() > shoulders.neck_back.y()) shoulders.neck_back = point;
    if (front.empty() || shoulders.neck_back == base)
        throw InputError(place, "no throat or nape: between the sides of the neck there is a gap",
                         "a body with a neck");
    shoulders.neck_front = front.front();
    for (const Vec3& point : crossings(outline, base, Vec3(0, shoulders.neck_axis.y(), shoulders.neck_axis.z())))
        if (point.y() < shoulders.neck_front.y()) shoulders.neck_front = point;
    if (const std::optional<Vec3> hollow = hollow_in(front)) shoulders.neck_front = *hollow;
}

}  // namespace

bool Shoulders::above_neck_base(const Vec3& point) const
{
    const BasePlane plane = base_plane(*this, point.y() > 0.5 * (neck_side[0] + neck_side[1]).y());
    return (point - plane.middle).dot(plane.up) > 0;
}

Shoulders find_shoulders(const Anatomy& body, double neck_level, const InputPlace& place)
{
    Shoulders shoulders;
    find_neck(body, neck_level, shoulders);
    double half = 0;
    const Tape level = tape_around(body.skin, body.trunk, Vec3(0, 0, neck_level), Vec3::UnitZ());
    for (const Vec3& point : level.points) half = std::max(half, std::abs(point.x() - shoulders.neck_middle.x()));
    find_neck_and_shoulder_points(body, neck_level, half, place, shoulders);

    find_throat_and_nape(body, place, shoulders);
    for (const bool back : {false, true}) shoulders.neck_base[back] = half_of_base(body, shoulders, back);
    return shoulders;
}

}  // namespace selvage
