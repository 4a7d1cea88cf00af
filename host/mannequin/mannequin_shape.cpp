#include "host/mannequin/mannequin_shape.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <Eigen/Geometry>

#include "host/mesh/convex_hull.hpp"

namespace selvage {
namespace {

/// Union of two shapes with a fillet of size k [m], twice differentiable.
/// Source: Quilez 2013, Smooth minimum (cubic polynomial).
double smooth_union(double a, double b, double k)
{
    const double h = std::max(k - std::abs(a - b), 0.0) / k;
    return std::min(a, b) - h * h * h * k / 6;
}

double ellipsoid(const Vec3& point, const Vec3& centre, const Vec3& radii)
{
    const Vec3 p = (point - centre).cwiseQuotient(radii);
    const double k0 = p.norm();
    return k0 < 1e-9 ? -radii.minCoeff() : k0 * (k0 - 1) / p.cwiseQuotient(radii).norm();
}

/// Distance to a capsule whose radius changes linearly from a to b.
double tapered_capsule(const Vec3& point, const Vec3& a, const Vec3& b, double radius_a, double radius_b)
{
    const double w = std::clamp((point - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
    return (point - a - w * (b - a)).norm() - (radius_a + w * (radius_b - radius_a));
}

constexpr double drawn_stature = 1.70;

double smooth_step(double from, double to, double x)
{
    const double w = std::clamp((x - from) / (to - from), 0.0, 1.0);
    return w * w * (3 - 2 * w);
}

}  // namespace

MannequinShape::MannequinShape(const MannequinMeasures& measures)
    : measures_(measures), figure_(drawing_of(measures.figure)), heights_(measures.figure, measures.stature),
      scale_(measures.stature / drawn_stature)
{
    const double angle = measures.arm_angle * std::numbers::pi / 180;
    along_ = Vec3(std::cos(angle), 0, -std::sin(angle));
    outer_ = Vec3(std::sin(angle), 0, std::cos(angle));
    calibrate();
}

Vec3 MannequinShape::arm_frame(const Vec3& point) const
{
    const Vec3 from_joint = Vec3(std::abs(point.x()), point.y(), point.z()) - joint_;
    return {from_joint.dot(along_), from_joint.y(), from_joint.dot(outer_)};
}

double MannequinShape::torso(const Vec3& point) const
{
    const double s = scale_, wide = s * figure_.shoulder;
    // A smooth approximation of |x|, so that mirrored shapes have no crease at
    // the centre line.
    const Vec3 side(std::sqrt(point.x() * point.x() + s * s * 2e-4), point.y(), point.z());
    double d = torso_.distance(point.z(), point.x(), point.y());
    for (const Bump* bump : {&chest_, &blade_, &seat_})
        d = smooth_union(d, ellipsoid(side, bump->centre, bump->radii), bump->fillet);
    const Vec3 root(0.02 * s, 0.022 * s, joint_.z() + 0.034 * s);
    d = smooth_union(d, tapered_capsule(side, root, joint_, 0.056 * wide, 0.046 * wide), 0.090 * s);
    // The trapezius: from the side of the neck to the shoulder.
    const Vec3 nape(0.030 * s, 0.034 * s, heights_(1.425)), end(0.80 * joint_.x(), 0.018 * s, joint_.z() + 0.016 * s);
    return smooth_union(d, tapered_capsule(side, nape, end, 0.030 * wide, 0.022 * wide), 0.050 * s);
}

double MannequinShape::head(const Vec3& point) const
{
    const double h = head_scale_, w = h * (1 + 0.10 * heights_.youth()), top = measures_.stature;
    const double cranium = ellipsoid(point, {0, 0.004 * h, top - 0.100 * h}, Vec3(0.074 * w, 0.093 * w, 0.100 * h));
    const double jaw = ellipsoid(point, {0, -0.034 * h, top - 0.150 * h}, Vec3(0.050 * w, 0.054 * w, 0.074 * h));
    return smooth_union(cranium, jaw, 0.060 * h);
}

double MannequinShape::leg(const Vec3& point) const
{
    const double s = scale_, x = std::abs(point.x());
    const double limb = leg_.distance(point.z(), x, point.y());
    if (point.z() > 0.25 * s) return limb;
    const double turn = 0.14;  // Toes point outwards by this angle [rad].
    const Vec2 ankle(0.110 * s, 0.024 * s);
    const double u = x - ankle.x(), v = point.y() - ankle.y();
    const double along = u * std::sin(turn) - v * std::cos(turn), across = u * std::cos(turn) + v * std::sin(turn);
    const double d = smooth_union(limb, foot_.distance(along, across, point.z()), 0.045 * s);
    return -smooth_union(-d, point.z(), 0.012 * s);
}

double MannequinShape::arm(const Vec3& point) const
{
    const Vec3 p = arm_frame(point);
    const double limb = arm_.distance(p.x(), p.y(), p.z());
    const double tilt = 0.80;  // Of the thumb away from the arm's axis [rad].
    const double t = p.x() - wrist_ - 0.020 * scale_, u = p.y() + 0.030 * scale_;
    const double along = t * std::cos(tilt) - u * std::sin(tilt), across = t * std::sin(tilt) + u * std::cos(tilt);
    return smooth_union(limb, thumb_.distance(along, across, p.z() - hand_offset_), 0.016 * scale_);
}

double MannequinShape::trunk(const Vec3& point) const
{
    const double s = scale_, z = point.z();
    // The fillet is wide at the crotch and narrow at the sides, where thigh and
    // hip touch along their length.
    const double crease = std::max(0.034 - 0.6 * point.x() * point.x() / (s * s), 0.016);
    double d = z > heights_(0.60) ? torso(point) : 1.0;
    if (z > heights_(1.20)) {
        d = smooth_union(d, neck_.distance(z, point.x(), point.y()), 0.050 * s);
        d = smooth_union(d, head(point), 0.035 * s);
    }
    if (z < heights_(1.10)) d = smooth_union(d, leg(point), crease * s);
    return d;
}

double MannequinShape::operator()(const Vec3& point) const
{
    const double body = trunk(point);
    const Vec3 p = arm_frame(point);
    // The fillet is wide over the shoulder, and narrow under the arm and further
    // along it, to avoid webbing.
    const double over = smooth_step(-0.05 * scale_, 0.035 * scale_, p.z());
    const double near = 1 - smooth_step(0.10 * scale_, 0.25 * scale_, p.x());
    const double fillet = scale_ * (0.010 + near * (0.010 + 0.060 * over));
    return smooth_union(body, arm(point), fillet);
}

Vec3 MannequinShape::with_arms_at(double arm_angle, const Vec3& point) const
{
    const double blend = 0.03 * scale_;  // Half the width of the region between
                                         // arm and trunk that stretches [m].
    const double share = smooth_step(-blend, blend, trunk(point) - arm(point));
    const double angle = (measures_.arm_angle + share * (arm_angle - measures_.arm_angle)) * std::numbers::pi / 180;
    const Vec3 along(std::cos(angle), 0, -std::sin(angle)), outer(std::sin(angle), 0, std::cos(angle));
    const Vec3 p = arm_frame(point);
    const Vec3 turned = joint_ + p.x() * along + Vec3(0, p.y(), 0) + p.z() * outer;
    return {std::copysign(turned.x(), point.x()), turned.y(), turned.z()};
}

Vec3 MannequinShape::exit_point(const Vec3& start, const Vec3& direction, double reach) const
{
    double inside = 0, outside = 0;
    const double stride = 0.004;
    while (outside < reach && (*this)(start + outside * direction) < 0) {
        inside = outside;
        outside += stride;
    }
    for (int halving = 0; halving < 20; ++halving) {
        const double middle = 0.5 * (inside + outside);
        ((*this)(start + middle * direction) < 0 ? inside : outside) = middle;
    }
    return start + outside * direction;
}

MannequinShape::Section MannequinShape::section(const Vec3& inside, const Vec3& u, const Vec3& v) const
{
    const int ray_count = 120;
    std::vector<Vec2> points;
    Section found;
    for (int ray = 0; ray < ray_count; ++ray) {
        const double angle = 2 * std::numbers::pi * ray / ray_count;
        const Vec2 direction(std::cos(angle), std::sin(angle));
        double near = 0, far = 0.6 * scale_;
        for (int halving = 0; halving < 16; ++halving) {
            const double middle = 0.5 * (near + far);
            const Vec2 at = middle * direction;
            (trunk(inside + at.x() * u + at.y() * v) < 0 ? near : far) = middle;
        }
        points.push_back(near * direction);
        found.middle += near * near * near * direction / (3 * ray_count);
        found.area += near * near / (2 * ray_count);
    }
    found.middle *= 1 / found.area;
    found.girth = perimeter(convex_hull(std::move(points)));
    return found;
}

double MannequinShape::level_girth(double height) const
{
    return section(Vec3(0, 0, height), Vec3::UnitX(), Vec3::UnitY()).girth;
}

double MannequinShape::hip_girth() const
{
    double widest = 0;
    for (const double shift : {-0.016, -0.008, 0.0, 0.008})
        widest = std::max(widest, level_girth(heights_(figure_.hip_height + shift)));
    return widest;
}

double MannequinShape::neck_girth() const
{
    const double step = 0.0025 * measures_.stature, half = 0.012 * measures_.stature;
    const auto level = [&](double z) {
        return section(Vec3(0, neck_.section(z).centre_v, z), Vec3::UnitX(), Vec3::UnitY());
    };
    double narrowest = heights_(1.425), shortest = 1e9;
    for (double z = narrowest; z < heights_(1.480); z += step)
        if (const double here = level(z).girth; here < shortest) {
            shortest = here;
            narrowest = z;
        }
    const auto middle = [&](double z) { return Vec3(0, neck_.section(z).centre_v + level(z).middle.y(), z); };
    const Vec3 axis = (middle(narrowest + half) - middle(narrowest - half)).normalized(), at = middle(narrowest);
    for (int k = -8; k < 8; ++k)
        shortest = std::min(shortest, section(at + k * step * axis, Vec3::UnitX(), axis.cross(Vec3::UnitX())).girth);
    return shortest;
}

Vec3 MannequinShape::armpit() const
{
    // The highest place between arm and trunk, seen from the middle of the shoulder and of the arm.
    Vec3 highest(joint_.x(), joint_.y(), -1);
    const double step = 0.004 * scale_, bottom = joint_.z() - 0.25 * scale_;
    for (double x = 0.6 * joint_.x(); x < joint_.x() + 0.08 * scale_; x += step) {
        double z = joint_.z() + std::max(x - joint_.x(), 0.0) * along_.z() / along_.x();
        while (z > bottom && (*this)(Vec3(x, joint_.y(), z)) < 0) z -= step;
        if (z <= bottom) continue;
        const double fine = exit_point(Vec3(x, joint_.y(), z + step), -Vec3::UnitZ(), 2 * step).z();
        if (fine > highest.z()) highest = Vec3(x, joint_.y(), fine);
    }
    return highest;
}

void MannequinShape::calibrate()
{
    const MannequinMeasures& m = measures_;
    draw();
    for (int round = 0; round < 6; ++round) {
        factors_.bust *= m.bust / level_girth(heights_(figure_.bust_height));
        factors_.waist *= m.waist / level_girth(heights_(figure_.waist_height));
        factors_.hips *= m.hips / hip_girth();
        factors_.neck *= m.neck / neck_girth();
        draw();
    }
}

MannequinLandmarks MannequinShape::landmarks() const
{
    const double s = scale_;
    MannequinLandmarks at;
    at.bust_height = heights_(figure_.bust_height);
    at.waist_height = heights_(figure_.waist_height);
    at.hip_height = heights_(figure_.hip_height);
    at.crotch_height = heights_(0.785);
    at.neck_height = heights_(1.452);
    const double base = heights_(1.415);
    at.neck_base = Vec3(0, neck_.section(base).centre_v, base);
    for (double z = at.crotch_height; z < at.neck_base.z(); z += 0.01 * s)
        for (double x : {0.0, 0.04, 0.08, 0.12}) {
            const Vec3 inside(x * s, 0.01 * s, z);
            if (trunk(inside) > 0) continue;
            at.front = std::min(at.front, exit_point(inside, -Vec3::UnitY(), 0.4).y());
            at.back = std::max(at.back, exit_point(inside, Vec3::UnitY(), 0.4).y());
        }
    const TubeStation wrist = arm_.section(wrist_);
    at.upper_arm_radius = arm_.section(0.15 * wrist_).radius_u;
    at.wrist_radius = wrist.radius_u;
    const double neck_side_x = measures_.neck / (2 * std::numbers::pi) + 0.020 * s;
    const std::array<Vec3, 2> on_left{exit_point({neck_side_x, 0.01 * s, joint_.z()}, Vec3::UnitZ(), 0.2),
                                      exit_point(joint_, Vec3(1, 0, 1).normalized(), 0.2)};
    const Vec3 wrist_centre = joint_ + wrist_ * along_ + wrist.centre_u * Vec3::UnitY() + wrist.centre_v * outer_;
    for (int hand = 0; hand < 2; ++hand) {
        const Eigen::Array3d mirror(hand == 0 ? 1 : -1, 1, 1);
        auto mirrored = [&](const Vec3& point) { return Vec3(point.array() * mirror); };
        at.neck_side[hand] = mirrored(on_left[0]);
        at.shoulder_point[hand] = mirrored(on_left[1]);
        at.shoulder_joint[hand] = mirrored(joint_);
        at.armpit[hand] = mirrored(armpit());
        at.arm_direction[hand] = mirrored(along_);
        at.wrist[hand] = mirrored(wrist_centre);
    }
    return at;
}

BodyPart MannequinShape::part(const Vec3& point) const
{
    const double s = scale_;
    const bool left = point.x() > 0;
    const Vec3 p = arm_frame(point);
    if (p.x() > 0.02 * s && arm(point) < trunk(point)) return left ? BodyPart::left_arm : BodyPart::right_arm;
    // Planes divide the parts: the jaw line rises to the back of the head, the
    // neck line falls to the front, the groin rises outwards.
    if (point.z() - 0.45 * point.y() > heights_(1.490)) return BodyPart::head;
    if (point.z() - 0.35 * point.y() > heights_(1.410) && std::abs(point.x()) < 0.12 * s) return BodyPart::neck;
    if (point.z() - 0.5 * std::abs(point.x()) < heights_(0.775)) return left ? BodyPart::left_leg : BodyPart::right_leg;
    return BodyPart::torso;
}

}  // namespace selvage
