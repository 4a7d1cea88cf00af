#include "host/styles/blocks/style_measures.hpp"

#include <cmath>
#include <string>
#include <string_view>

namespace selvage {
namespace {

// Looks up what a draft needs, by name.
class Lookup {
public:
    Lookup(const BodyMeasures& found, const InputPlace& place) : found_(found), place_(place) {}

    double girth(std::string_view name) const { return value_of(found_.girth(name), name); }
    double length(std::string_view name) const { return value_of(found_.length(name), name); }

    Vec3 point(const std::string& name) const
    {
        const Landmark* landmark = found_.landmark(name);
        if (!landmark) refuse(name);
        return found_.frame.to_body(landmark->position);
    }

    // {left, right}, made symmetric.
    std::array<Vec3, 2> pair(const std::string& name) const
    {
        const Vec3 left = point("left_" + name), right = point("right_" + name);
        const Vec3 mean(0.5 * (left.x() - right.x()), 0.5 * (left.y() + right.y()), 0.5 * (left.z() + right.z()));
        return {mean, Vec3(-mean.x(), mean.y(), mean.z())};
    }

private:
    double value_of(const BodyMeasure* measure, std::string_view name) const
    {
        if (!measure) refuse(name);
        return measure->value;
    }

    [[noreturn]] void refuse(std::string_view name) const
    {
        throw InputError(place_, "a body on which `" + std::string(name) + "` is not found",
                         "a body that shows every measure of a draft, see `selvage measure`; or garment.size");
    }

    const BodyMeasures& found_;
    const InputPlace& place_;
};

void sort_points(const TriangleMesh& mesh, const BodyMeasures& found, StyleBody& body)
{
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
        const Vec3 x = found.frame.to_body(mesh.vertices[v]);
        body.all.push_back(x);
        switch (found.regions[v]) {
            case BodyRegion::torso:
            case BodyRegion::neck:
                body.trunk.push_back(x);
                break;
            case BodyRegion::head:
                body.head.push_back(x);
                break;
            case BodyRegion::left_arm:
            case BodyRegion::left_hand:
                body.arm[0].push_back(x);
                break;
            case BodyRegion::right_arm:
            case BodyRegion::right_hand:
                body.arm[1].push_back(x);
                break;
            case BodyRegion::left_leg:
            case BodyRegion::left_foot:
                body.leg[0].push_back(x);
                break;
            case BodyRegion::right_leg:
            case BodyRegion::right_foot:
                body.leg[1].push_back(x);
                break;
            case BodyRegion::loose:
                break;
        }
    }
}

}  // namespace

StyleBody style_body(const TriangleMesh& mesh, const InputPlace& place)
{
    const BodyMeasures found = measure_body(mesh, place);
    const Lookup on(found, place);
    StyleBody body;
    body.frame = found.frame;
    const Vec3 neck_side = on.pair("neck_side")[0];
    body.shoulder = on.pair("shoulder");
    body.armpit = on.pair("armpit");
    body.wrist = on.pair("wrist");
    body.ankle = on.pair("ankle");
    body.neck_front = on.point("neck_front");
    body.neck_back = on.point("neck_back");
    body.neck_side_height = neck_side.z();
    body.shoulder_height = body.shoulder[0].z();
    body.armpit_height = body.armpit[0].z();
    body.bust_height = on.point("bust_front").z();
    body.waist_height = on.point("waist_front").z();
    body.hip_height = on.point("hips_front").z();
    body.crotch_height = on.point("crotch").z();
    body.waist_y = 0.5 * (on.point("waist_front").y() + on.point("waist_back").y());

    StyleMeasures& m = body.measures;
    m.stature = found.height;
    m.bust = on.girth("bust");
    m.waist = on.girth("waist");
    m.hips = on.girth("hips");
    m.neck = on.girth("neck");
    m.upper_arm = on.girth("upper_arm");
    m.wrist = on.girth("wrist");
    m.thigh = on.girth("thigh");
    m.ankle = on.girth("ankle");
    m.neck_width = on.length("neck_width");
    m.shoulder_width = 2 * body.shoulder[0].x();
    m.shoulder_drop = neck_side.z() - body.shoulder[0].z();
    m.armscye_depth = neck_side.z() - body.armpit[0].z();
    m.neck_to_waist = neck_side.z() - body.waist_height;
    m.waist_to_hips = body.waist_height - body.hip_height;
    m.body_rise = body.waist_height - body.crotch_height;
    m.arm_length = (body.wrist[0] - body.shoulder[0]).norm();
    m.inside_leg = body.crotch_height;
    m.waist_to_knee = body.waist_height - on.pair("knee")[0].z();
    sort_points(mesh, found, body);
    return body;
}

}  // namespace selvage
