#include "host/body/limb_levels.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "host/body/trunk_levels.hpp"

namespace selvage {
namespace {

/// Where levels are looked for, over the height.
struct LimbWindows {
    static constexpr double step = 0.0025;
    static constexpr double axis_half = 0.025;                     // half the piece of an arm that gives its axis
    static constexpr double around = 0.08;                         // how far the skin of a section lies along the arm
    static constexpr double wrist_low = 0.085, wrist_high = 0.15;  // from the tip of the hand; a hand has 0.108
    static constexpr double upper_arm_low = 0.012, upper_arm_high = 0.04;  // below the armpit
    static constexpr double thigh_below_crotch = 0.01;
    static constexpr double ankle_low = 0.03, ankle_high = 0.13;
    static constexpr double calf_low = 0.13, calf_high = 0.25;
    static constexpr double knee_low = 0.48, knee_high = 0.80;  // over the height of the crotch
    static constexpr double least_knee = 0.001;                 // by which a kneecap stands out
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

void find_arm(const Anatomy& body, int side, LimbLevels& levels)
{
    const double h = body.height, armpit = body.limbs.from_hand[side][body.limbs.armpits[side]];
    const Arm arm(body, side);
    for (double d = LimbWindows::wrist_low * h; d < LimbWindows::wrist_high * h; d += LimbWindows::step * h) {
        std::optional<LimbTape> found = arm.at(d);
        if (found && (!levels.wrist[side] || found->tape.length < levels.wrist[side]->tape.length))
            levels.wrist[side] = std::move(found);
    }
    for (double d = LimbWindows::upper_arm_low * h; d < LimbWindows::upper_arm_high * h;
         d += 2 * LimbWindows::step * h) {
        std::optional<LimbTape> found = arm.at(armpit - d);
        if (found && (!levels.upper_arm[side] || found->tape.length > levels.upper_arm[side]->tape.length))
            levels.upper_arm[side] = std::move(found);
    }
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

std::vector<LegSection> leg_sections(const Anatomy& body, int side)
{
    std::vector<LegSection> sections;
    for (double z = LimbWindows::ankle_low * body.height; z < body.crotch; z += LimbWindows::step * body.height) {
        const std::optional<LimbTape> found = leg_at(body, side, z);
        if (!found) continue;
        LegSection section{z, found->tape.length, found->tape.points.front().y()};
        for (const Vec3& point : found->tape.points) section.front = std::min(section.front, point.y());
        sections.push_back(section);
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

// The kneecap: what stands out most to the front between shin and thigh.
std::optional<double> knee_level(const Anatomy& body, const std::vector<LegSection>& sections)
{
    std::vector<Vec2> profile;
    for (const LegSection& section : sections)
        if (section.z > LimbWindows::knee_low * body.crotch && section.z < LimbWindows::knee_high * body.crotch)
            profile.emplace_back(section.z, section.front);
    const int bend = bend_of(profile, -1);
    if (bend < 0) return {};
    const Vec2 along = (profile.back() - profile.front()).normalized(), to = profile[bend] - profile.front();
    if (along.y() * to.x() - along.x() * to.y() < LimbWindows::least_knee * body.height) return {};
    return profile[bend].x();
}

void find_leg(const Anatomy& body, int side, LimbLevels& levels)
{
    const double h = body.height;
    const std::vector<LegSection> sections = leg_sections(body, side);
    levels.thigh[side] = leg_at(body, side, body.crotch - LimbWindows::thigh_below_crotch * h);
    std::optional<double> knee = knee_level(body, sections);
    levels.knee_is_cap = levels.knee_is_cap && knee;
    if (!knee)
        knee = extreme_girth(sections, LimbWindows::knee_low * body.crotch, LimbWindows::knee_high * body.crotch, -1);
    if (knee) levels.knee[side] = leg_at(body, side, *knee);
    if (const auto z = extreme_girth(sections, LimbWindows::calf_low * h, LimbWindows::calf_high * h, 1))
        levels.calf[side] = leg_at(body, side, *z);
    if (const auto z = extreme_girth(sections, LimbWindows::ankle_low * h, LimbWindows::ankle_high * h, -1))
        levels.ankle[side] = leg_at(body, side, *z);
}

}  // namespace

LimbLevels find_limb_levels(const Anatomy& body)
{
    LimbLevels levels;
    for (int side = 0; side < 2; ++side) {
        find_arm(body, side, levels);
        find_leg(body, side, levels);
    }
    return levels;
}

}  // namespace selvage
