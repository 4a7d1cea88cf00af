#include "host/styles/arrange.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "host/garment/assemble.hpp"
#include "host/garment/outline.hpp"
#include "host/styles/blocks/placement.hpp"
#include "host/styles/panel_parts.hpp"

namespace selvage {
namespace {

constexpr double above_shoulder =
    0.01;  // of a torso panel's top over the side of the neck [m]: cloth rests on it later

/// How a panel is turned in its own plane before it is placed, which leaves its grain alone.
struct Turn {
    bool mirrored = false;
    double angle = 0;  // counter-clockwise, after mirroring [rad]

    Eigen::Matrix2d matrix() const
    {
        Eigen::Matrix2d turn;
        turn << std::cos(angle), -std::sin(angle), std::sin(angle), std::cos(angle);
        return turn * Eigen::DiagonalMatrix<double, 2>(mirrored ? -1 : 1, 1);
    }
};

PatternPanel turned(PatternPanel panel, const Turn& turn)
{
    const Eigen::Matrix2d m = turn.matrix();
    for (Vec2& vertex : panel.vertices) vertex = m * vertex;
    for (PatternEdge& edge : panel.edges) {
        for (Vec2& control : edge.control) control = m * control;
        edge.right = edge.right != turn.mirrored;
    }
    panel.wrap.reset();
    return panel;
}

// Gives a panel the place that its turned copy has been given.
void take_place(PatternPanel& panel, const PatternPanel& copy, const Turn& turn)
{
    Mat3 m = Mat3::Identity();
    m.topLeftCorner<2, 2>() = turn.matrix();
    m(2, 2) = turn.mirrored ? -1 : 1;
    panel.rotation = copy.rotation * m;
    panel.translation = copy.translation;
    panel.wrap = copy.wrap;
    if (!panel.wrap) return;
    panel.wrap->x0 *= turn.mirrored ? -1 : 1;
    panel.wrap->behind = turn.mirrored;
}

struct Range {
    double low = std::numeric_limits<double>::infinity(), high = -std::numeric_limits<double>::infinity();
    void add(double value)
    {
        low = std::min(low, value);
        high = std::max(high, value);
    }
    double middle() const { return 0.5 * (low + high); }
};

Range range_of(const PatternPanel& panel, int axis)
{
    Range range;
    for (const Vec2& point : sample_outline(panel, std::vector<int>(panel.edges.size(), 16))) range.add(point[axis]);
    return range;
}

/// A panel's edge and the edge that it is sewn to.
struct Joint {
    int own = 0, panel = 0, other = 0;
};

class Arrangement {
public:
    Arrangement(Pattern& pattern, const StyleBody& body, std::vector<PanelRole> roles)
        : pattern_(pattern), body_(body), roles_(std::move(roles)), joints_(pattern.panels.size()),
          placed_(pattern.panels.size())
    {
        for (const PatternStitch& stitch : pattern.stitches) {
            if (stitch.a.panel == stitch.b.panel) continue;
            joints_[stitch.a.panel].push_back({stitch.a.edge, stitch.b.panel, stitch.b.edge});
            joints_[stitch.b.panel].push_back({stitch.b.edge, stitch.a.panel, stitch.a.edge});
        }
    }

    void place_all()
    {
        for (int next = first(); next >= 0; next = following()) {
            place(next);
            placed_[next] = 1;
        }
    }

private:
    // What hangs from the body, before what hangs from it.
    static int rank(GarmentPart part)
    {
        switch (part) {
            case GarmentPart::torso:
                return 0;
            case GarmentPart::waistband:
                return 1;
            case GarmentPart::skirt:
            case GarmentPart::leg:
                return 2;
            default:
                return 3;
        }
    }

    int first() const
    {
        int best = 0;
        for (int p = 1; p < int(roles_.size()); ++p)
            if (rank(roles_[p].part) < rank(roles_[best].part)) best = p;
        return best;
    }

    // The panel with most edges on placed ones, of the lowest rank; -1: all are placed.
    int following() const
    {
        int best = -1;
        std::pair<int, int> least{};
        for (int p = 0; p < int(roles_.size()); ++p) {
            if (placed_[p]) continue;
            const int joined = int(std::ranges::count_if(joints_[p], [&](const Joint& j) { return placed_[j.panel]; }));
            // A panel of the trunk without neighbours waits for none: fronts are often joined by backs only.
            const std::pair<int, int> key{rank(roles_[p].part) + (joined == 0 ? 4 : 0), -joined};
            if (best < 0 || key < least) {
                best = p;
                least = key;
            }
        }
        return best;
    }

    Vec2 own_middle(int p, int edge) const
    {
        return EdgePath(pattern_.panels[p], pattern_.panels[p].edges[edge]).at(0.5);
    }

    Vec3 point_at(int p, int edge, double fraction) const
    {
        const PatternPanel& panel = pattern_.panels[p];
        return place_on_panel(panel, EdgePath(panel, panel.edges[edge]).at(fraction));
    }

    // How far the seams to placed panels are open [m^2].
    double openness(int p) const
    {
        double sum = 0;
        for (const Joint& j : joints_[p]) {
            if (!placed_[j.panel]) continue;
            const auto apart = [&](double own, double other) {
                return (point_at(p, j.own, own) - point_at(j.panel, j.other, other)).squaredNorm();
            };
            sum += apart(0.5, 0.5) + std::min(apart(0, 0) + apart(1, 1), apart(0, 1) + apart(1, 0));
        }
        return sum;
    }

    bool is_limb(int p) const
    {
        if (roles_[p].part == GarmentPart::sleeve) return true;
        return roles_[p].part == GarmentPart::cuff && std::ranges::any_of(joints_[p], [&](const Joint& j) {
                   return roles_[j.panel].part == GarmentPart::sleeve;
               });
    }

    // The side of the body that a panel covers; sleeves that do not say so are where their neighbours are.
    int side_of(int p) const
    {
        if (roles_[p].side != 0) return roles_[p].side;
        double x = 0;
        for (const Joint& j : joints_[p])
            if (placed_[j.panel]) x += point_at(j.panel, j.other, 0.5).x();
        return x < 0 ? -1 : 1;
    }

    void place(int p)
    {
        PatternPanel& panel = pattern_.panels[p];
        PatternPanel best = panel;
        double least = std::numeric_limits<double>::infinity();
        for (const bool mirrored : {false, true}) {
            is_limb(p) ? place_on_arm(p, mirrored) : place_upright(p, mirrored);
            // Outside is where the outline runs counter-clockwise: that decides where seams do not.
            const double area = signed_area(sample_outline(panel, std::vector<int>(panel.edges.size(), 16)));
            const double open = openness(p) + ((area < 0) == mirrored ? 0 : 1e-4);
            if (open >= least) continue;
            least = open;
            best = panel;
        }
        panel = best;
    }

    // Height of a panel's y = 0 [m], and where across the body its neighbours' edges are.
    double height_of(int p, const PatternPanel& copy, Range& across) const
    {
        double sum = 0;
        int count = 0;
        for (const Joint& j : joints_[p]) {
            if (!placed_[j.panel]) continue;
            const Vec3 there = point_at(j.panel, j.other, 0.5);
            across.add(there.x());
            sum += there.z() - own_middle(p, j.own).y();
            ++count;
        }
        const double top = range_of(copy, 1).high;
        if (roles_[p].part == GarmentPart::torso) return body_.neck_side_height + above_shoulder - top;
        if (count > 0) return sum / count;
        const bool neck = roles_[p].part == GarmentPart::collar || roles_[p].part == GarmentPart::hood;
        return neck ? body_.neck_side_height - range_of(copy, 1).low : body_.waist_height - top;
    }

    void place_upright(int p, bool mirrored)
    {
        const Turn turn{mirrored, 0};
        PatternPanel copy = turned(pattern_.panels[p], turn);
        const PanelRole& role = roles_[p];
        const Range x = range_of(copy, 0);
        Range across;
        const double height = height_of(p, copy, across);
        if (role.part == GarmentPart::hood || (role.face == 0 && role.side != 0)) {
            const Vec2 beside = beside_neighbours(p, copy);
            hang_flat(copy, body_.all, {0, beside.y(), 0}, Vec3(side_of(p), 0, 0), height, beside.x());
        } else if (role.face == 0) {  // around all of the body
            const double y =
                role.part == GarmentPart::collar ? 0.5 * (body_.neck_front.y() + body_.neck_back.y()) : body_.waist_y;
            roll_around(copy, points_of(role.part), {0, y, height}, -Vec3::UnitZ(), -Vec3::UnitY(), x.middle());
        } else {
            const Vec3 outward(0, -role.face, 0);
            // Seen from outside, the wearer's left is at the right of the front and at the left of the back.
            const double to_left = role.face;
            const bool half = role.side != 0;
            const double middle = !half ? x.middle() : role.side * to_left > 0 ? x.low : x.high;
            const double axis = role.order >= 0 && across.low <= across.high ? across.middle() : 0;
            hang_around(copy, points_of(role.part), {axis, body_.waist_y, 0}, outward, height, middle);
        }
        take_place(pattern_.panels[p], copy, turn);
    }

    // For a panel that hangs at a side of the body: its x that is where its neighbours' edges are on average, and their
    // y.
    Vec2 beside_neighbours(int p, const PatternPanel& copy) const
    {
        Vec2 sum = Vec2::Zero();
        int count = 0;
        for (const Joint& j : joints_[p]) {
            if (!placed_[j.panel] || roles_[j.panel].part == roles_[p].part) continue;
            sum += Vec2(EdgePath(copy, copy.edges[j.own]).at(0.5).x(), point_at(j.panel, j.other, 0.5).y());
            ++count;
        }
        if (count == 0) return {range_of(copy, 0).middle(), body_.waist_y};
        return sum / count;
    }

    std::vector<Vec3> points_of(GarmentPart part) const
    {
        if (part == GarmentPart::torso || part == GarmentPart::collar) return body_.all;
        std::vector<Vec3> points = body_.trunk;
        for (const auto& leg : body_.leg) points.insert(points.end(), leg.begin(), leg.end());
        return points;
    }

    // The direction in a panel's plane that points up the arm: from its middle to what is sewn to the trunk, or, of a
    // cuff, to its sleeve. Panels are drawn upright or level.
    Vec2 up_of(int p) const
    {
        Vec2 sum = Vec2::Zero();
        int count = 0;
        for (const Joint& j : joints_[p]) {
            if (!placed_[j.panel] || roles_[j.panel].part == roles_[p].part) continue;
            sum += own_middle(p, j.own);
            ++count;
        }
        const PatternPanel& panel = pattern_.panels[p];
        const Vec2 middle(range_of(panel, 0).middle(), range_of(panel, 1).middle());
        if (count == 0 || (sum / count - middle).norm() < 1e-6) return Vec2::UnitY();
        const Vec2 up = sum / count - middle;
        int axis = 0;
        up.cwiseAbs().maxCoeff(&axis);
        return (up[axis] < 0 ? -1 : 1) * Vec2(Vec2::Unit(axis));
    }

    void place_on_arm(int p, bool mirrored)
    {
        const int side = side_of(p), index = side > 0 ? 0 : 1;
        const Vec3 shoulder = body_.shoulder[index], along = (body_.wrist[index] - shoulder).normalized();
        Vec2 up = up_of(p);
        if (mirrored) up.x() = -up.x();
        const Turn turn{mirrored, std::atan2(up.x(), up.y())};
        PatternPanel copy = turned(pattern_.panels[p], turn);
        double down = StartGaps::beyond_shoulder, sum = 0;  // of the panel's top, from the shoulder
        int count = 0;
        for (const Joint& j : joints_[p])
            if (placed_[j.panel] && roles_[p].part == GarmentPart::cuff) {
                sum += (point_at(j.panel, j.other, 0.5) - shoulder).dot(along);
                ++count;
            }
        if (count > 0) down = sum / count;
        const Vec3 start = shoulder + (down + range_of(copy, 1).high) * along;
        const Vec3 above = Vec3(Vec3::UnitZ() - along.z() * along).normalized();
        const int face = roles_[p].face;
        const bool rolls = face == 0 && std::abs(std::sin(turn.angle)) < 1e-9;
        if (rolls && turn.angle == 0) {
            roll_around(copy, body_.arm[index], start, along, above, range_of(copy, 0).middle());
        } else {
            hang_beside_arm(copy, index, start, along, face == 0 ? above : Vec3(0, -face, 0));
        }
        take_place(pattern_.panels[p], copy, turn);
    }

    // Flat, its y up the arm, clear of it.
    void hang_beside_arm(PatternPanel& copy, int index, const Vec3& start, const Vec3& along, const Vec3& side) const
    {
        const Vec3 outward = (side - side.dot(along) * along).normalized();
        double distance = 0;
        const Range y = range_of(copy, 1);
        for (const Vec3& x : body_.arm[index]) {
            const double down = (x - start).dot(along);
            if (-down > y.low && -down < y.high) distance = std::max(distance, (x - start).dot(outward));
        }
        copy.rotation << Vec3(-along).cross(outward), -along, outward;
        copy.translation =
            start + (distance + StartGaps::limb) * outward - range_of(copy, 0).middle() * Vec3(copy.rotation.col(0));
    }

    Pattern& pattern_;
    const StyleBody& body_;
    std::vector<PanelRole> roles_;
    std::vector<std::vector<Joint>> joints_;  // of each panel
    std::vector<char> placed_;
};

std::vector<PanelRole> roles_of(const Pattern& pattern, const std::map<std::string, std::string>& parts)
{
    std::vector<PanelRole> roles;
    for (std::size_t p = 0; p < pattern.panels.size(); ++p) {
        const std::string& name = pattern.panels[p].name;
        const auto given = parts.find(name);
        const std::optional<PanelRole> role = panel_role(given != parts.end() ? given->second : name);
        if (!role)
            throw InputError(given != parts.end() ? InputPlace{{}, 0, 0, "garment.parts." + name}
                                                  : pattern.place("pattern.panels." + name),
                             given != parts.end() ? "`" + given->second + "`"
                                                  : "a panel without a place whose name tells no part of the body",
                             "side, face and part, such as `left front torso`, `right sleeve` or `skirt back`, as its "
                             "name or in [garment.parts]; or garment.arrange = \"never\"");
        roles.push_back(*role);
    }
    return roles;
}

}  // namespace

bool is_unplaced(const Pattern& pattern)
{
    const auto lies_as_first = [&](const PatternPanel& panel) {
        const PatternPanel& first = pattern.panels.front();
        return panel.translation.isApprox(first.translation) && panel.rotation.isApprox(first.rotation) && !panel.wrap;
    };
    return pattern.panels.size() > 1 && std::ranges::all_of(pattern.panels, lies_as_first);
}

void arrange(Pattern& pattern, const StyleBody& body, const std::map<std::string, std::string>& parts)
{
    std::vector<std::string> names;
    for (const PatternPanel& panel : pattern.panels) names.push_back(panel.name);
    for (const auto& [name, description] : parts)
        if (std::ranges::find(names, name) == names.end())
            throw InputError({{}, 0, 0, "garment.parts." + name}, "an unknown panel `" + name + "`",
                             "the name of a panel of the pattern", nearest_name(name, names));
    for (PatternPanel& panel : pattern.panels) {
        panel.translation.setZero();
        panel.rotation.setIdentity();
        panel.wrap.reset();
    }
    Arrangement(pattern, body, roles_of(pattern, parts)).place_all();
    move_to_mesh(pattern, body.frame);
}

}  // namespace selvage
