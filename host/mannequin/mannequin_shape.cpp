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

double smooth_step(double from, double to, double x)
{
    const double w = std::clamp((x - from) / (to - from), 0.0, 1.0);
    return w * w * (3 - 2 * w);
}

}  // namespace

MannequinShape::MannequinShape(const MannequinMeasures& measures) : measures_(measures)
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
    const double s = scale_;
    // A smooth approximation of |x|, so that mirrored shapes have no crease at the centre line.
    const Vec3 side(std::sqrt(point.x() * point.x() + s * s * 4e-4), point.y(), point.z());
    const double wide = factors_.bust * measures_.bust / 0.92, hip = factors_.hips * measures_.hips;
    double d = torso_.distance(point.z(), point.x(), point.y());
    const double breast =
        ellipsoid(side, {0.076 * wide, -0.051 * wide, 1.222 * s}, Vec3(0.068 * wide, 0.063 * wide, 0.080 * s));
    d = smooth_union(d, breast, 0.075 * s);
    const double buttock =
        ellipsoid(side, {0.078 * hip, 0.050 * hip, 0.870 * s}, Vec3(0.082 * hip, 0.078 * hip, 0.105 * s));
    d = smooth_union(d, buttock, 0.060 * s);
    const Vec3 root(0.02 * s, 0.020 * s, joint_.z() + 0.038 * s);
    const double shoulder = tapered_capsule(side, root, joint_, 0.060 * s, 0.046 * s);
    return smooth_union(d, shoulder, 0.090 * s);
}

double MannequinShape::head(const Vec3& point) const
{
    const double s = scale_, top = measures_.stature;
    const double cranium = ellipsoid(point, {0, 0.004 * s, top - 0.100 * s}, s * Vec3(0.074, 0.093, 0.100));
    const double jaw = ellipsoid(point, {0, -0.034 * s, top - 0.150 * s}, s * Vec3(0.050, 0.054, 0.074));
    return smooth_union(cranium, jaw, 0.060 * s);
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
    const double tilt = 0.55;  // Of the thumb away from the arm's axis [rad].
    const double t = p.x() - measures_.arm_length - 0.020 * scale_, u = p.y() + 0.030 * scale_;
    const double along = t * std::cos(tilt) - u * std::sin(tilt), across = t * std::sin(tilt) + u * std::cos(tilt);
    return smooth_union(limb, thumb_.distance(along, across, p.z() - hand_offset_), 0.022 * scale_);
}

double MannequinShape::trunk(const Vec3& point) const
{
    const double s = scale_, z = point.z();
    // The fillet is wide at the crotch and narrow at the sides, where thigh and hip touch along their length.
    const double crease = std::max(0.034 - 0.6 * point.x() * point.x() / (s * s), 0.016);
    double d = z > 0.60 * s ? torso(point) : 1.0;
    if (z > 1.20 * s) {
        d = smooth_union(d, neck_.distance(z, point.x(), point.y()), 0.050 * s);
        d = smooth_union(d, head(point), 0.035 * s);
    }
    if (z < 1.10 * s) d = smooth_union(d, leg(point), crease * s);
    return d;
}

double MannequinShape::operator()(const Vec3& point) const
{
    const double body = trunk(point);
    const Vec3 p = arm_frame(point);
    // The fillet is wide over the shoulder, and narrow under the arm and further along it, to avoid webbing.
    const double over = smooth_step(-0.05 * scale_, 0.035 * scale_, p.z());
    const double near = 1 - smooth_step(0.10 * scale_, 0.25 * scale_, p.x());
    const double fillet = scale_ * (0.010 + near * (0.010 + 0.060 * over));
    return smooth_union(body, arm(point), fillet);
}

Vec3 MannequinShape::with_arms_at(double arm_angle, const Vec3& point) const
{
    const double blend = 0.03 * scale_;  // Half the width of the region between arm and trunk that stretches [m].
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

double MannequinShape::girth(double height) const
{
    const int ray_count = 180;
    std::vector<Vec2> points;
    for (int ray = 0; ray < ray_count; ++ray) {
        const double angle = 2 * std::numbers::pi * ray / ray_count;
        const Vec2 direction(std::cos(angle), std::sin(angle));
        double inside = 0, outside = 0.6 * scale_;
        for (int halving = 0; halving < 22; ++halving) {
            const double middle = 0.5 * (inside + outside);
            const Vec2 at = middle * direction;
            (trunk({at.x(), at.y(), height}) < 0 ? inside : outside) = middle;
        }
        points.push_back(inside * direction);
    }
    return perimeter(convex_hull(std::move(points)));
}

void MannequinShape::calibrate()
{
    const MannequinMeasures& m = measures_;
    factors_.joint_x = 0.5 * m.shoulder_width;
    draw();
    for (int round = 0; round < 8; ++round) {
        const MannequinLandmarks at = landmarks();
        factors_.bust *= m.bust / girth(at.bust_height);
        factors_.waist *= m.waist / girth(at.waist_height);
        factors_.hips *= m.hips / girth(at.hip_height);
        factors_.neck *= m.neck / girth(at.neck_height);
        draw();
    }
}

MannequinLandmarks MannequinShape::landmarks() const
{
    const double s = scale_;
    MannequinLandmarks at;
    at.bust_height = 1.215 * s;
    at.waist_height = 1.065 * s;
    at.hip_height = 0.875 * s;
    at.crotch_height = 0.785 * s;
    at.neck_height = 1.452 * s;
    at.neck_base = Vec3(0, neck_.section(1.415 * s).centre_v, 1.415 * s);
    for (double z = at.crotch_height; z < at.neck_base.z(); z += 0.01 * s)
        for (double x : {0.0, 0.04, 0.08, 0.12}) {
            const Vec3 inside(x * s, 0.01 * s, z);
            if (trunk(inside) > 0) continue;
            at.front = std::min(at.front, exit_point(inside, -Vec3::UnitY(), 0.4).y());
            at.back = std::max(at.back, exit_point(inside, Vec3::UnitY(), 0.4).y());
        }
    at.upper_arm_radius = arm_.section(0.15 * measures_.arm_length).radius_u;
    at.wrist_radius = arm_.section(measures_.arm_length).radius_u;
    const TubeStation wrist = arm_.section(measures_.arm_length);
    const double neck_side_x = measures_.neck / (2 * std::numbers::pi) + 0.020 * s;
    const std::array<Vec3, 2> on_left{exit_point({neck_side_x, 0.01 * s, joint_.z()}, Vec3::UnitZ(), 0.2),
                                      exit_point(joint_, Vec3(1, 0, 1).normalized(), 0.2)};
    const Vec3 armpit = exit_point(joint_, (along_ - Vec3::UnitZ()).normalized(), 0.35);
    const Vec3 wrist_centre =
        joint_ + measures_.arm_length * along_ + wrist.centre_u * Vec3::UnitY() + wrist.centre_v * outer_;
    for (int hand = 0; hand < 2; ++hand) {
        const Eigen::Array3d mirror(hand == 0 ? 1 : -1, 1, 1);
        auto mirrored = [&](const Vec3& point) { return Vec3(point.array() * mirror); };
        at.neck_side[hand] = mirrored(on_left[0]);
        at.shoulder_point[hand] = mirrored(on_left[1]);
        at.shoulder_joint[hand] = mirrored(joint_);
        at.armpit[hand] = mirrored(armpit);
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
    // Planes divide the parts: the jaw line rises to the back of the head, the neck line falls to the front, the
    // groin rises outwards.
    if (point.z() - 0.45 * point.y() > 1.490 * s) return BodyPart::head;
    if (point.z() - 0.35 * point.y() > 1.410 * s && std::abs(point.x()) < 0.12 * s) return BodyPart::neck;
    if (point.z() - 0.5 * std::abs(point.x()) < 0.775 * s) return left ? BodyPart::left_leg : BodyPart::right_leg;
    return BodyPart::torso;
}

}  // namespace selvage
