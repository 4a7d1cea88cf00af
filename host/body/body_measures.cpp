#include "host/body/body_measures.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "host/body/geodesic.hpp"
#include "host/body/limb_levels.hpp"
#include "host/body/shoulders.hpp"
#include "host/body/trunk_levels.hpp"
#include "host/mesh/convex_hull.hpp"

namespace selvage {
namespace {

constexpr double most_sides_differ = 0.15;  // left and right of a girth; more is a fault of the mesh, not of the body
// From the joint to the top of the shoulder, over the height: with arms lowered by an angle, the tape runs over that
// much of its circle. GarmentCode's mean body in A and in T pose then has arms equally long.
constexpr double shoulder_radius = 0.030;
constexpr const char* over_hole = ", over a hole of the mesh";
constexpr std::array<const char*, 2> side_names{"left", "right"};

template <class Item>
const Item* named(const std::vector<Item>& items, std::string_view name)
{
    const auto found = std::find_if(items.begin(), items.end(), [&](const Item& item) { return item.name == name; });
    return found == items.end() ? nullptr : &*found;
}

// All that is found on a body, in its own frame.
struct Found {
    Anatomy body;
    TrunkLevels levels;
    Shoulders shoulders;
    LimbLevels limbs;
};

// Turns what was found into named measures.
class Measuring {
public:
    explicit Measuring(const Found& found)
        : found_(found), body_(found.body),
          middle_section_(section(found.body.skin, found.body.trunk, Vec3::Zero(), Vec3::UnitX()))
    {
    }

    BodyMeasures measures()
    {
        result_.height = body_.height;
        result_.frame = body_.limbs.frame;
        result_.area_share = body_.skin.area_share;
        for (const OpenEdge& edge : body_.skin.rims)
            result_.open_edges += (body_.at(edge.to) - body_.at(edge.from)).norm();
        add_trunk_girths();
        add_limb_girths();
        add_landmarks();
        add_lengths();
        add_limb_lines();
        return std::move(result_);
    }

private:
    using LimbPlace = std::array<std::optional<LimbTape>, 2>;

    std::vector<Vec3> in_file(std::vector<Vec3> points) const
    {
        for (Vec3& x : points) x = body_.limbs.frame.to_file(x);
        return points;
    }

    void add_girth(const char* name, const Tape& tape, const std::string& where)
    {
        if (tape.points.empty()) {
            result_.missing.push_back(name);
            return;
        }
        result_.girths.push_back(
            {name, tape.length, where + (tape.over_hole ? over_hole : ""), {in_file(tape.points)}, true});
    }

    void add_level(const char* name, std::optional<double> z, const std::string& where)
    {
        if (!z) {
            result_.missing.push_back(name);
            return;
        }
        const Tape tape = tape_around(body_.skin, body_.trunk, Vec3(0, 0, *z), Vec3::UnitZ());
        add_girth(name, tape, fmt::format("{}, {:.1f} cm above the ground", where, 100 * *z));
    }

    void add_limbs(const char* name, const LimbPlace& at, const std::string& where)
    {
        const bool both = at[0] && at[1];
        if ((!at[0] && !at[1]) || (both && std::abs(at[0]->tape.length - at[1]->tape.length) >
                                               most_sides_differ * (at[0]->tape.length + at[1]->tape.length) / 2)) {
            result_.missing.push_back(name);
            return;
        }
        BodyMeasure girth{name, 0, where, {}, true};
        bool hole = false;
        for (const std::optional<LimbTape>& tape : at) {
            if (!tape) continue;
            girth.value += tape->tape.length / (both ? 2 : 1);
            girth.lines.push_back(in_file(tape->tape.points));
            hole = hole || tape->tape.over_hole;
        }
        if (hole) girth.where += over_hole;
        result_.girths.push_back(std::move(girth));
    }

    void add_trunk_girths()
    {
        const TrunkLevels& levels = found_.levels;
        add_girth("neck", found_.shoulders.neck, "shortest around the neck");
        add_neck_base();
        add_level("bust", levels.bust, levels.bust_is_foremost ? "foremost of the chest" : "just below the armpits");
        add_level("underbust", levels.underbust, "bend of the girth below the bust");
        add_level("waist", levels.waist,
                  levels.waist_is_narrowest ? "narrowest of the trunk" : "hollow of the back, not narrowest");
        add_level("hips", levels.hips,
                  levels.hips_are_widest ? "widest above the crotch" : "hindmost of the seat, below a belly");
    }

    void add_neck_base()
    {
        const auto& [front, back] = found_.shoulders.neck_base;
        if (front.points.empty() || back.points.empty()) {
            result_.missing.push_back("neck_base");
            return;
        }
        const double across = (found_.shoulders.neck_side[0] - found_.shoulders.neck_side[1]).norm();
        result_.girths.push_back({"neck_base",
                                  front.length + back.length - 2 * across,
                                  "over the sides of the neck, nape and hollow of the throat",
                                  {in_file(front.points), in_file(back.points)},
                                  true});
    }

    void add_limb_girths()
    {
        const LimbLevels& limbs = found_.limbs;
        add_limbs("upper_arm", limbs.upper_arm, "widest just below the armpit, across the arm");
        add_limbs("wrist", limbs.wrist, "at the bone above the narrowest place, across the arm");
        add_limbs("thigh", limbs.thigh, "just below the crotch, level");
        add_limbs("knee", limbs.knee,
                  limbs.knee_is_cap ? "at the kneecap, level" : "narrowest between thigh and calf, level");
        add_limbs("calf", limbs.calf, "widest below the knee, level");
        add_limbs("ankle", limbs.ankle, "narrowest above the foot, level");
    }

    void add_landmark(const std::string& name, const Vec3& point)
    {
        result_.landmarks.push_back({name, body_.limbs.frame.to_file(point)});
    }

    void add_limb_landmarks(const std::string& name, const LimbPlace& at)
    {
        for (int side = 0; side < 2; ++side)
            if (at[side]) add_landmark(fmt::format("{}_{}", side_names[side], name), at[side]->middle);
    }

    void add_pair(const std::string& name, const std::array<Vec3, 2>& points)
    {
        for (int side = 0; side < 2; ++side) add_landmark(fmt::format("{}_{}", side_names[side], name), points[side]);
    }

    // The front and the back of a level in the middle of the body.
    void add_level_landmarks(const std::string& name, std::optional<double> z)
    {
        if (!z) return;
        for (const bool front : {true, false})
            if (const std::optional<Vec3> point = on_middle(*z, front))
                add_landmark(fmt::format("{}_{}", name, front ? "front" : "back"), *point);
    }

    std::optional<Vec3> on_middle(double z, bool front) const
    {
        std::optional<Vec3> found;
        const Vec3 level(0, 0, z);
        for (const Vec3& point : crossings(middle_section_, level, Vec3::UnitZ()))
            if (!found || (front ? point.y() < found->y() : point.y() > found->y())) found = point;
        return found;
    }

    void add_landmarks()
    {
        const Shoulders& shoulders = found_.shoulders;
        const TrunkLevels& levels = found_.levels;
        const Limbs& limbs = body_.limbs;
        add_landmark("crown", body_.at(limbs.crown));
        add_landmark("neck_front", shoulders.neck_front);
        add_landmark("neck_back", shoulders.neck_back);
        add_pair("neck_side", shoulders.neck_side);
        add_pair("shoulder", shoulders.shoulder);
        add_pair("armpit", body_.armpits);
        add_level_landmarks("bust", levels.bust);
        add_level_landmarks("underbust", levels.underbust);
        add_level_landmarks("waist", levels.waist);
        add_level_landmarks("hips", levels.hips);
        add_landmark("crotch", body_.crotch_point);
        add_limb_landmarks("wrist", found_.limbs.wrist);
        add_limb_landmarks("knee", found_.limbs.knee);
        add_limb_landmarks("ankle", found_.limbs.ankle);
        add_pair("hand_tip", {body_.at(limbs.hand_tips[0]), body_.at(limbs.hand_tips[1])});
        add_pair("foot_tip", {body_.at(limbs.foot_tips[0]), body_.at(limbs.foot_tips[1])});
    }

    void add_length(const char* name, double value, const std::string& where, std::vector<std::vector<Vec3>> lines = {})
    {
        BodyMeasure length{name, value, where, {}, false};
        for (std::vector<Vec3>& line : lines) length.lines.push_back(in_file(std::move(line)));
        result_.lengths.push_back(std::move(length));
    }

    // A tape down the middle of the body, from a point to a level: the convex side of the outline between them.
    void add_middle_tape(const char* name, const Vec3& from, std::optional<double> to, bool front,
                         const std::string& where)
    {
        const std::optional<Vec3> end = to ? on_middle(*to, front) : std::nullopt;
        if (!end) {
            result_.missing.push_back(name);
            return;
        }
        const double outward = front ? -1 : 1, inside = -10;  // far inside: those two points close the polygon there
        std::vector<Vec2> points{
            {from.z(), outward * from.y()}, {end->z(), outward * end->y()}, {from.z(), inside}, {end->z(), inside}};
        for (const Vec3& x : middle_section_)
            if (x.z() < from.z() && x.z() > end->z()) points.emplace_back(x.z(), outward * x.y());
        std::vector<Vec3> line;
        for (const Vec2& p : convex_hull(std::move(points)))
            if (p.y() != inside) line.emplace_back(0, outward * p.y(), p.x());
        std::sort(line.begin(), line.end(), [](const Vec3& a, const Vec3& b) { return a.z() > b.z(); });
        double length = 0;
        for (std::size_t k = 1; k < line.size(); ++k) length += (line[k] - line[k - 1]).norm();
        add_length(name, length, where, {line});
    }

    void add_lengths()
    {
        const Shoulders& shoulders = found_.shoulders;
        const TrunkLevels& levels = found_.levels;
        add_length("shoulder_width", (shoulders.shoulder[0] - shoulders.shoulder[1]).norm(),
                   "between the shoulder points, straight");
        add_length("neck_width", (shoulders.neck_side[0] - shoulders.neck_side[1]).norm(),
                   "between the sides of the neck, straight");
        add_length("shoulder_length",
                   0.5 * ((shoulders.shoulder[0] - shoulders.neck_side[0]).norm() +
                          (shoulders.shoulder[1] - shoulders.neck_side[1]).norm()),
                   "side of the neck to the shoulder point, straight");
        add_middle_tape("neck_to_waist_back", shoulders.neck_back, levels.waist, false, "down the middle of the back");
        add_middle_tape("neck_to_waist_front", shoulders.neck_front, levels.waist, true,
                        "down the middle of the front");
        add_height("waist_height", levels.waist);
        add_height("hip_height", levels.hips);
        add_length("inseam", body_.crotch, "crotch to the ground, upright");
        add_arm_lengths();
    }

    void add_height(const char* name, std::optional<double> z)
    {
        if (z) add_length(name, *z, "above the ground");
    }

    void add_arm_lengths()
    {
        double arm = 0, shoulder = 0;
        int count = 0;
        for (int side = 0; side < 2; ++side) {
            const std::optional<LimbTape>& wrist = found_.limbs.wrist[side];
            if (!wrist) continue;
            const std::vector<double> from =
                geodesic_distances(body_.skin, sources_at(found_.shoulders.shoulder[side]));
            // As long as with arms at 45 degrees, for which the shoulder point is defined.
            const double raised = M_PI / 4 - body_.arm_drop[side];
            arm += distance_to(from, wrist->tape) + raised * shoulder_radius * body_.height;
            shoulder += from[nearest_vertex(found_.shoulders.neck_back)];
            ++count;
        }
        if (count == 0) {
            result_.missing.insert(result_.missing.end(), {"arm_length", "sleeve_length"});
            return;
        }
        add_length("arm_length", arm / count, "shoulder point to the wrist, over the skin, for arms at 45 degrees");
        add_length("sleeve_length", (arm + shoulder) / count, "back of the neck over the shoulder point to the wrist");
    }

    void add_limb_lines()
    {
        const auto add = [&](const char* limb, const std::array<std::vector<LimbTape>, 2>& lines) {
            for (int side = 0; side < 2; ++side) {
                LimbLine line{fmt::format("{}_{}", side_names[side], limb), {}};
                for (const LimbTape& at : lines[side])
                    line.sections.push_back({body_.limbs.frame.to_file(at.middle), at.tape.length});
                result_.limbs.push_back(std::move(line));
            }
        };
        add("arm", found_.limbs.arm_line);
        add("leg", found_.limbs.leg_line);
    }

    int nearest_vertex(const Vec3& point) const
    {
        const auto nearer = [&](const Vec3& a, const Vec3& b) {
            return (a - point).squaredNorm() < (b - point).squaredNorm();
        };
        return int(std::min_element(body_.skin.vertices.begin(), body_.skin.vertices.end(), nearer) -
                   body_.skin.vertices.begin());
    }

    // The corners of the faces around a point of the skin, with their distance from it.
    std::vector<GeodesicSource> sources_at(const Vec3& point) const
    {
        std::vector<GeodesicSource> sources;
        for (const int f : body_.skin.faces_of(nearest_vertex(point)))
            for (const int v : body_.skin.faces[f]) sources.push_back({v, (body_.at(v) - point).norm()});
        return sources;
    }

    // The least distance of a tape's corners, by way of the vertices nearest to them.
    double distance_to(const std::vector<double>& from, const Tape& tape) const
    {
        double least = 1e9;
        for (const Vec3& corner : tape.points) {
            const int v = nearest_vertex(corner);
            least = std::min(least, from[v] + (body_.at(v) - corner).norm());
        }
        return least;
    }

    const Found& found_;
    const Anatomy& body_;
    std::vector<Vec3> middle_section_;  // of the trunk, front to back
    BodyMeasures result_;
};

// Tells head, neck, hands and feet from what they grow out of.
void refine_regions(Found& found)
{
    Anatomy& body = found.body;
    const Shoulders& shoulders = found.shoulders;
    const double jaw_slope = 0.45;  // of the plane below the head, which rises from the chin to the back of the head
    const double neck_half = 1.15 * std::abs(shoulders.neck_side[0].x() - shoulders.neck_side[1].x()) / 2;
    for (std::size_t v = 0; v < body.regions.size(); ++v) {
        BodyRegion& region = body.regions[v];
        const Vec3& x = body.skin.vertices[v];
        if (region == BodyRegion::torso) {
            const Vec3 above = x - shoulders.neck_middle;
            if (above.z() - jaw_slope * above.y() > 0.015 * body.height)
                region = BodyRegion::head;
            else if (shoulders.above_neck_base(x) && std::abs(x.x()) < neck_half)
                region = BodyRegion::neck;
            continue;
        }
        for (int side = 0; side < 2; ++side) {
            const bool left = side == 0;
            if (region == (left ? BodyRegion::left_arm : BodyRegion::right_arm)) {
                const std::optional<LimbTape>& wrist = found.limbs.wrist[side];
                if (wrist && body.limbs.from_hand[side][v] < wrist->from_tip + 0.03 * body.height &&
                    (x - wrist->middle).dot(wrist->axis) > 0)
                    region = left ? BodyRegion::left_hand : BodyRegion::right_hand;
            } else if (region == (left ? BodyRegion::left_leg : BodyRegion::right_leg)) {
                const std::optional<LimbTape>& ankle = found.limbs.ankle[side];
                if (ankle && x.z() < ankle->middle.z()) region = left ? BodyRegion::left_foot : BodyRegion::right_foot;
            }
        }
    }
}

}  // namespace

const BodyMeasure* BodyMeasures::girth(std::string_view name) const { return named(girths, name); }
const BodyMeasure* BodyMeasures::length(std::string_view name) const { return named(lengths, name); }
const Landmark* BodyMeasures::landmark(std::string_view name) const { return named(landmarks, name); }
const LimbLine* BodyMeasures::limb(std::string_view name) const { return named(limbs, name); }

BodyMeasures measure_body(const TriangleMesh& mesh, const InputPlace& place)
{
    Found found;
    found.body = make_anatomy(make_skin(mesh), place);
    found.levels = find_levels(found.body, trunk_sections(found.body), place);
    found.shoulders = find_shoulders(found.body, found.levels.neck, place);
    found.limbs = find_limb_levels(found.body);
    BodyMeasures measures = Measuring(found).measures();
    refine_regions(found);
    for (const int v : found.body.skin.of_given)
        measures.regions.push_back(v < 0 ? BodyRegion::loose : found.body.regions[v]);
    return measures;
}

}  // namespace selvage
