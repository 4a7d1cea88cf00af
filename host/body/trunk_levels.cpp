#include "host/body/trunk_levels.hpp"

#include <algorithm>
#include <cmath>

#include "host/body/bend.hpp"

namespace selvage {
namespace {

/// Where levels are looked for, over the height; each window is open to all bodies of the data and the mannequins.
struct LevelWindows {
    static constexpr double step = 0.0025;
    static constexpr double waist_above_crotch = 0.10, waist_below_armpit = 0.045;
    // Without a belly the waist lies 0.02 above the hollow of the back, where the girth is 1.025 times as large.
    static constexpr double narrowest_above_hollow = 0.03, belly = 1.05;
    static constexpr double hips_above_crotch = 0.01, hips_below_belly = 0.11;
    static constexpr double bust_below_armpit = 0.075, bust_above_armpit = 0.03, chest_below_armpit = 0.025;
    static constexpr double neck_above_armpit = 0.03, neck_below_crown = 0.085;
    static constexpr double underbust_bend = 0.01;  // of the bust girth; less than that is no bend
    static constexpr double neck_share = 0.9;       // of the head's girth
};

using Sections = std::vector<TrunkSection>;

bool by_girth(const TrunkSection& a, const TrunkSection& b) { return a.girth < b.girth; }

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

double girth_at(const Sections& sections, double z)
{
    for (const TrunkSection& section : sections)
        if (section.z >= z) return section.girth;
    return 0;
}

void find_waist(const Anatomy& body, const Sections& sections, double armpit, TrunkLevels& levels)
{
    const double h = body.height;
    const Sections window = between(sections, body.crotch + LevelWindows::waist_above_crotch * h,
                                    armpit - LevelWindows::waist_below_armpit * h);
    const std::optional<double> narrowest = inner_minimum(window, [](const TrunkSection& s) { return s.girth; });
    const std::optional<double> hollow = inner_minimum(window, [](const TrunkSection& s) { return s.back; });
    // Over a belly the narrowest place lies under the chest, and the girth grows from there to the hollow.
    const bool belly = narrowest && hollow && *narrowest - *hollow > LevelWindows::narrowest_above_hollow * h &&
                       girth_at(window, *hollow) > LevelWindows::belly * girth_at(window, *narrowest);
    levels.waist_is_narrowest = narrowest && !belly;
    levels.waist = levels.waist_is_narrowest ? narrowest : hollow;
}

// The widest place near the crotch; where it only grows towards the belly, the hindmost place of the seat.
void find_hips(const Anatomy& body, const Sections& sections, TrunkLevels& levels)
{
    const double h = body.height, low = body.crotch + LevelWindows::hips_above_crotch * h;
    const Sections window = between(sections, low, body.crotch + LevelWindows::hips_below_belly * h);
    if (window.empty()) return;
    const auto widest = std::max_element(window.begin(), window.end(), by_girth);
    levels.hips_are_widest = widest + 1 != window.end();
    levels.hips = widest->z;
    if (!levels.hips_are_widest) levels.hips = inner_minimum(window, [](const TrunkSection& s) { return -s.back; });
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
    // Girths and heights have the same scale here: both in metres.
    const Bend bend = find_bend(curve, BendSide::right);
    if (bend.point >= 0 && bend.depth > LevelWindows::underbust_bend * curve.back().y())
        levels.underbust = curve[bend.point].x();
}

}  // namespace

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
    find_hips(body, sections, levels);
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
