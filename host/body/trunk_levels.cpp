#include "host/body/trunk_levels.hpp"

#include <algorithm>
#include <cmath>

namespace selvage {
namespace {

/// Where levels are looked for, over the height; each window is open to all bodies of the data and the mannequins.
struct LevelWindows {
    static constexpr double step = 0.0025;
    static constexpr double waist_above_crotch = 0.10, waist_below_armpit = 0.045;
    static constexpr double hips_above_crotch = 0.01;
    static constexpr double bust_below_armpit = 0.075, bust_above_armpit = 0.03, chest_below_armpit = 0.025;
    static constexpr double neck_above_armpit = 0.03, neck_below_crown = 0.085;
    static constexpr double underbust_bend = 0.01;  // of the bust girth; less than that is no bend
    static constexpr double neck_share = 0.75;      // of the head's girth
};

using Sections = std::vector<TrunkSection>;

Sections between(const Sections& sections, double low, double high)
{
    Sections within;
    std::copy_if(sections.begin(), sections.end(), std::back_inserter(within),
                 [&](const TrunkSection& s) { return s.z >= low && s.z <= high; });
    return within;
}

// The least value strictly within a window, as far as it is a local one.
template <class Value>
std::optional<double> inner_minimum(const Sections& window, const Value& value)
{
    std::optional<double> level;
    double least = 0;
    for (std::size_t k = 2; k + 2 < window.size(); ++k) {
        const double here = value(window[k]);
        const bool local = here <= value(window[k - 1]) && here <= value(window[k + 1]) &&
                           here <= value(window[k - 2]) && here <= value(window[k + 2]);
        if (!local || (level && here >= least)) continue;
        level = window[k].z;
        least = here;
    }
    return level;
}

void find_waist(const Anatomy& body, const Sections& sections, double armpit, TrunkLevels& levels)
{
    const double h = body.height;
    const Sections window = between(sections, body.crotch + LevelWindows::waist_above_crotch * h,
                                    armpit - LevelWindows::waist_below_armpit * h);
    levels.waist = inner_minimum(window, [](const TrunkSection& s) { return s.girth; });
    levels.waist_is_narrowest = levels.waist.has_value();
    if (!levels.waist) levels.waist = inner_minimum(window, [](const TrunkSection& s) { return s.back; });
}

void find_bust(const Anatomy& body, const Sections& sections, double armpit, TrunkLevels& levels)
{
    const double h = body.height;
    levels.bust = inner_minimum(
        between(sections, armpit - LevelWindows::bust_below_armpit * h, armpit + LevelWindows::bust_above_armpit * h),
        [](const TrunkSection& s) { return s.front; });
    levels.bust_is_foremost = levels.bust.has_value();
    if (!levels.bust) levels.bust = armpit - LevelWindows::chest_below_armpit * h;
    if (!levels.waist) return;
    std::vector<Vec2> curve;
    const Sections below = between(sections, *levels.waist, *levels.bust);
    for (const TrunkSection& s : below) curve.emplace_back(s.z, s.girth);
    const int bend = bend_of(curve, -1);
    if (bend < 0) return;
    const double share = (curve[bend].x() - curve.front().x()) / (curve.back().x() - curve.front().x());
    const double chord = curve.front().y() + share * (curve.back().y() - curve.front().y());
    if (chord - curve[bend].y() > LevelWindows::underbust_bend * curve.back().y()) levels.underbust = curve[bend].x();
}

}  // namespace

int bend_of(const std::vector<Vec2>& curve, double side)
{
    int bend = -1;
    double furthest = 0;
    for (std::size_t k = 1; k + 1 < curve.size(); ++k) {
        const Vec2 along = curve.back() - curve.front(), to = curve[k] - curve.front();
        const double distance = side * (along.x() * to.y() - along.y() * to.x());
        if (distance <= furthest) continue;
        furthest = distance;
        bend = int(k);
    }
    return bend;
}

std::vector<TrunkSection> trunk_sections(const Anatomy& body)
{
    std::vector<TrunkSection> sections;
    for (double z = body.crotch; z < body.height; z += LevelWindows::step * body.height) {
        const Tape tape = tape_around(body.skin, body.trunk, Vec3(0, 0, z), Vec3::UnitZ());
        if (tape.points.empty()) continue;
        const auto [front, back] = std::minmax_element(tape.points.begin(), tape.points.end(),
                                                       [](const Vec3& a, const Vec3& b) { return a.y() < b.y(); });
        sections.push_back({z, tape.length, front->y(), back->y()});
    }
    return sections;
}

TrunkLevels find_levels(const Anatomy& body, const std::vector<TrunkSection>& sections, const InputPlace& place)
{
    TrunkLevels levels;
    const double armpit = 0.5 * (body.armpits[0].z() + body.armpits[1].z()), h = body.height;
    find_waist(body, sections, armpit, levels);
    find_bust(body, sections, armpit, levels);
    if (levels.waist) {
        const Sections below = between(sections, body.crotch + LevelWindows::hips_above_crotch * h, *levels.waist);
        const auto widest = std::max_element(
            below.begin(), below.end(), [](const TrunkSection& a, const TrunkSection& b) { return a.girth < b.girth; });
        if (widest != below.end()) levels.hips = widest->z;
    }
    const auto by_girth = [](const TrunkSection& a, const TrunkSection& b) { return a.girth < b.girth; };
    const Sections upper =
        between(sections, armpit + LevelWindows::neck_above_armpit * h, h * (1 - LevelWindows::neck_below_crown));
    const auto neck = std::min_element(upper.begin(), upper.end(), by_girth);
    const auto head = std::max_element(neck, upper.end(), by_girth);
    if (neck == upper.end() || neck->girth > LevelWindows::neck_share * head->girth)
        throw InputError(place, "no neck: nothing above the armpits is narrower than what is on top of it",
                         "a body with a head on a neck");
    levels.neck = neck->z;
    return levels;
}

}  // namespace selvage
