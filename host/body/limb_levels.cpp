#include "host/body/limb_levels.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "host/body/bend.hpp"

namespace selvage {
namespace {

/// Where levels are looked for, over the height.
struct LimbWindows {
    static constexpr double step = 0.0025;
    // Of the centre lines; from the tip of the hand, beyond which sections cut through fingers; above the ground.
    static constexpr double line_step = 0.015, palm = 0.075, sole = 0.03;
    static constexpr double axis_half = 0.025;                     // half the piece of an arm that gives its axis
    static constexpr double around = 0.08;                         // how far the skin of a section lies along the arm
    static constexpr double wrist_low = 0.085, wrist_high = 0.15;  // from the tip of the hand; a hand has 0.108
    static constexpr double wrist_bone = 0.005;                    // above the narrowest place
    static constexpr double upper_arm_low = 0.012, upper_arm_high = 0.04;  // below the armpit
    static constexpr double thigh_below_crotch = 0.01;
    static constexpr double least_knee = 0.0008;  // by which a kneecap stands out
    // Over the height of the crotch, since children have short legs.
    static constexpr double ankle_low = 0.066, ankle_high = 0.287;
    static constexpr double calf_low = 0.287, calf_high = 0.55;
    static constexpr double knee_low = 0.48, knee_high = 0.72;
};

// Follows one arm from the tip of its hand.
class Arm {
public:
    Arm(const Anatomy& body, int side) : body_(body), mask_(body.arms[side]), from_hand_(body.limbs.from_hand[side]) {}

    // The tape across the arm at a distance from the tip of the hand.
    std::optional<LimbTape> at(double from_tip) const
    {
        const double h = body_.height;
        Vec3 nearer, farther, middle;
        if (!centre(from_tip - LimbWindows::axis_half * h, nearer) ||
            !centre(from_tip + LimbWindows::axis_half * h, farther) || !centre(from_tip, middle))
            return {};
        LimbTape found;
        found.axis = (nearer - farther).normalized();
        FaceMask near = mask_;
        for (std::size_t f = 0; f < near.size(); ++f)
            if (near[f] && std::abs(from_hand_[body_.skin.faces[f][0]] - from_tip) > LimbWindows::around * h)
                near[f] = 0;
        found.tape = tape_around(body_.skin, near, middle, found.axis);
        if (found.tape.points.empty()) return {};
        found.middle = found.tape.middle();
        found.from_tip = from_tip;
        return found;
    }

private:
    // The centre of the ring of skin at a distance from the tip.
    bool centre(double from_tip, Vec3& middle) const
    {
        double area = 0;
        middle = Vec3::Zero();
        for (std::size_t v = 0; v < from_hand_.size(); ++v) {
            if (std::abs(from_hand_[v] - from_tip) > 0.01 * body_.height) continue;
            area += body_.skin.area[v];
            middle += body_.skin.area[v] * body_.skin.vertices[v];
        }
        if (!(area > 0)) return false;
        middle /= area;
        return true;
    }

    const Anatomy& body_;
    const FaceMask& mask_;
    const std::vector<double>& from_hand_;
};

// The distance from the tip of the hand at which an arm is narrowest, if that is not at an end of the window.
std::optional<double> narrowest_wrist(const Arm& arm, double height)
{
    std::vector<Vec2> girths;
    for (double d = LimbWindows::wrist_low * height; d < LimbWindows::wrist_high * height;
         d += LimbWindows::step * height)
        if (const std::optional<LimbTape> found = arm.at(d)) girths.emplace_back(d, found->tape.length);
    const auto narrowest =
        std::min_element(girths.begin(), girths.end(), [](const Vec2& a, const Vec2& b) { return a.y() < b.y(); });
    if (girths.empty() || narrowest == girths.begin() || narrowest == girths.end() - 1) return {};
    return narrowest->x();
}

void find_arm(const Anatomy& body, int side, LimbLevels& levels)
{
    const double h = body.height, armpit = body.limbs.from_hand[side][body.limbs.armpits[side]];
    const Arm arm(body, side);
    if (const std::optional<double> wrist = narrowest_wrist(arm, h))
        levels.wrist[side] = arm.at(*wrist + LimbWindows::wrist_bone * h);
    for (double d = LimbWindows::upper_arm_low * h; d < LimbWindows::upper_arm_high * h;
         d += 2 * LimbWindows::step * h) {
        std::optional<LimbTape> found = arm.at(armpit - d);
        if (found && (!levels.upper_arm[side] || found->tape.length > levels.upper_arm[side]->tape.length))
            levels.upper_arm[side] = std::move(found);
    }
}

std::vector<LimbTape> arm_line(const Anatomy& body, int side)
{
    const double h = body.height, armpit = body.limbs.from_hand[side][body.limbs.armpits[side]];
    const Arm arm(body, side);
    std::vector<LimbTape> line;
    for (double d = armpit; d > LimbWindows::palm * h; d -= LimbWindows::line_step * h)
        if (std::optional<LimbTape> found = arm.at(d)) line.push_back(std::move(*found));
    return line;
}

// A level section of a leg.
struct LegSection {
    double z = 0, girth = 0, front = 0;  ///< [m]; front: least y.
};

std::optional<LimbTape> leg_at(const Anatomy& body, int side, double z)
{
    LimbTape found;
    found.tape = tape_around(body.skin, body.legs[side], Vec3(0, 0, z), Vec3::UnitZ());
    if (found.tape.points.empty()) return {};
    found.middle = found.tape.middle();
    found.axis = -Vec3::UnitZ();
    return found;
}

std::vector<LimbTape> leg_line(const Anatomy& body, int side)
{
    std::vector<LimbTape> line;
    for (double z = body.crotch - LimbWindows::thigh_below_crotch * body.height; z > LimbWindows::sole * body.height;
         z -= LimbWindows::line_step * body.height)
        if (std::optional<LimbTape> found = leg_at(body, side, z)) line.push_back(std::move(*found));
    return line;
}

std::optional<LegSection> leg_section(const Anatomy& body, int side, double z)
{
    const std::optional<LimbTape> found = leg_at(body, side, z);
    if (!found) return {};
    LegSection section{z, found->tape.length, found->tape.points.front().y()};
    for (const Vec3& point : found->tape.points) section.front = std::min(section.front, point.y());
    return section;
}

// The sections of both legs, at the same heights.
std::array<std::vector<LegSection>, 2> leg_sections(const Anatomy& body)
{
    std::array<std::vector<LegSection>, 2> sections;
    for (double z = LimbWindows::ankle_low * body.crotch; z < body.crotch; z += LimbWindows::step * body.height) {
        const std::optional<LegSection> left = leg_section(body, 0, z), right = leg_section(body, 1, z);
        if (!left || !right) continue;
        sections[0].push_back(*left);
        sections[1].push_back(*right);
    }
    return sections;
}

// The level of the least (sign -1) or greatest girth of a window, if it is not at one of its ends.
std::optional<double> extreme_girth(const std::vector<LegSection>& sections, double low, double high, double sign)
{
    std::vector<LegSection> window;
    for (const LegSection& section : sections)
        if (section.z >= low && section.z <= high) window.push_back(section);
    const auto best = std::max_element(window.begin(), window.end(), [&](const LegSection& a, const LegSection& b) {
        return sign * a.girth < sign * b.girth;
    });
    if (window.empty() || best == window.begin() || best == window.end() - 1) return {};
    return best->z;
}

// The kneecap: what stands out most to the front between shin and thigh, in the mean of both legs, since it is little.
std::optional<double> kneecap_level(const Anatomy& body, const std::array<std::vector<LegSection>, 2>& sections)
{
    std::vector<Vec2> profile;
    for (std::size_t k = 0; k < sections[0].size(); ++k) {
        const double z = sections[0][k].z;
        if (z > LimbWindows::knee_low * body.crotch && z < LimbWindows::knee_high * body.crotch)
            profile.emplace_back(z, (sections[0][k].front + sections[1][k].front) / 2);
    }
    const Bend bend = find_bend(profile, BendSide::right);
    if (bend.depth < LimbWindows::least_knee * body.height) return {};
    return profile[bend.middle].x();
}

void find_legs(const Anatomy& body, LimbLevels& levels)
{
    const std::array<std::vector<LegSection>, 2> sections = leg_sections(body);
    const std::optional<double> kneecap = kneecap_level(body, sections);
    levels.knee_is_cap = kneecap.has_value();
    for (int side = 0; side < 2; ++side) {
        const auto extreme = [&](double low, double high, double sign) {
            return extreme_girth(sections[side], low * body.crotch, high * body.crotch, sign);
        };
        levels.thigh[side] = leg_at(body, side, body.crotch - LimbWindows::thigh_below_crotch * body.height);
        const std::optional<double> knee =
            kneecap ? kneecap : extreme(LimbWindows::knee_low, LimbWindows::knee_high, -1);
        if (knee) levels.knee[side] = leg_at(body, side, *knee);
        if (const auto z = extreme(LimbWindows::calf_low, LimbWindows::calf_high, 1))
            levels.calf[side] = leg_at(body, side, *z);
        if (const auto z = extreme(LimbWindows::ankle_low, LimbWindows::ankle_high, -1))
            levels.ankle[side] = leg_at(body, side, *z);
    }
}

}  // namespace

LimbLevels find_limb_levels(const Anatomy& body)
{
    LimbLevels levels;
    for (int side = 0; side < 2; ++side) {
        find_arm(body, side, levels);
        levels.arm_line[side] = arm_line(body, side);
        levels.leg_line[side] = leg_line(body, side);
    }
    find_legs(body, levels);
    return levels;
}

}  // namespace selvage
