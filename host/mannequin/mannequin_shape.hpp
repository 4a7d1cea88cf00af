#pragma once
#include "host/mannequin/mannequin_figure.hpp"
#include "host/mannequin/mannequin_measures.hpp"
#include "host/mannequin/section_tube.hpp"

namespace selvage {

enum class BodyPart { head, neck, torso, left_arm, right_arm, left_leg, right_leg };

/// The mannequin as an implicit shape, symmetric in x: smooth unions of tubes
/// and ellipsoids. Limbs are described in the half space x >= 0 and mirrored.
class MannequinShape {
public:
    /// Calibrates the shape so that its girths and its shoulder width are those
    /// of `measures`.
    explicit MannequinShape(const MannequinMeasures& measures);

    double operator()(const Vec3& point) const;  ///< Signed distance [m], first order; negative inside.
    double trunk(const Vec3& point) const;       ///< The same without arms and hands.

    /// Returns where a point of the surface moves when the arms turn about the
    /// shoulder joints. The arms turn by the full angle, the trunk not at all,
    /// with a smooth transition in between.
    /// @param arm_angle  new angle below the horizontal [degrees]
    Vec3 with_arms_at(double arm_angle, const Vec3& point) const;

    BodyPart part(const Vec3& point) const;  ///< Part to which a point on the surface belongs.

    /// Returns the first point outside along a ray that starts inside, but at
    /// most `reach` [m] away.
    Vec3 exit_point(const Vec3& start, const Vec3& direction, double reach) const;

    MannequinLandmarks landmarks() const;
    const MannequinMeasures& measures() const { return measures_; }

private:
    /// Factors on the drawn sections, found by calibrate().
    struct Factors {
        double bust = 1, waist = 1, hips = 1, neck = 1;
    };

    void draw();
    void draw_torso();
    void draw_head();
    void draw_arm();
    void draw_leg();
    void calibrate();

    double torso(const Vec3& point) const;
    double head(const Vec3& point) const;
    double leg(const Vec3& point) const;
    /// A section of the trunk in a plane.
    struct Section {
        double girth = 0;            ///< Of a tape: the perimeter of the convex hull [m].
        double area = 0;             ///< Over 2 pi [m^2].
        Vec2 middle = Vec2::Zero();  ///< Of its area, from the point it was taken at [m].
    };

    /// @param inside  a point of the plane in the middle of the trunk
    /// @param u, v    unit vectors that span the plane
    Section section(const Vec3& inside, const Vec3& u, const Vec3& v) const;
    double level_girth(double height) const;
    double hip_girth() const;   ///< The widest.
    Vec3 armpit() const;        ///< The left one.
    double neck_girth() const;  ///< The shortest across the neck's axis, as
                                ///< measure_body() finds it.
    double arm(const Vec3& point) const;
    Vec3 arm_frame(const Vec3& point) const;  ///< (along, front-back, outer) coordinates of the arm at x >= 0.

    /// From the shoulder point to the joint, along a tape over the arm, for a
    /// stature of 1.70 m [m].
    static constexpr double shoulder_to_joint = 0.040;

    MannequinMeasures measures_;
    const FigureDrawing& figure_;
    HeightScale heights_;
    Factors factors_;
    double scale_ = 1;  ///< Stature over that of the drawing.
    double bust_ratio_ = 1,
           hips_ratio_ = 1;   ///< Girths over those of the drawing.
    double head_scale_ = 1;   ///< Height of the head over that of the drawing.
    double wrist_ = 0;        ///< Distance from the shoulder joint along the arm [m].
    double hand_offset_ = 0;  ///< Outward offset of the hand from the arm's axis [m].
    Bump chest_, blade_, seat_;
    Vec3 joint_ = Vec3::Zero(), along_ = Vec3::Zero(), outer_ = Vec3::Zero();
    SectionTube torso_, neck_, arm_, thumb_, leg_, foot_;
};

}  // namespace selvage
