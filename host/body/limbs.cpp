#include "host/body/limbs.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include "host/body/geodesic.hpp"
#include "host/body/merge_tree.hpp"

namespace selvage {
namespace {

/// In parts of the height, for bodies from one year of age on (the smallest have the longest trunk) to the longest
/// legs.
struct LimbLimits {
    static constexpr double persistence = 0.10;  // of the largest distance; fingers, ears and noise stay below 0.06
    static constexpr double least_share = 0.75;  // of the area in one piece; hair and clothes are less than a quarter
    static constexpr double foot_top = 0.12, hand_bottom = 0.2;
    static constexpr double crotch_low = 0.28, crotch_high = 0.62;
    static constexpr double armpit_low = 0.58, armpit_high = 0.92;
    static constexpr double foot_height = 0.04, ankle_low = 0.05, ankle_high = 0.08;
    static constexpr double least_foot = 0.15;  // (toes - heel) / (toes + heel), before and behind the ankle
    static constexpr double head_bottom = 0.90, trunk_top = 0.05, least_lean = 0.004;
    static constexpr double least_flatness = 1.25;  // of the torso's section, second moments: below, it shows no side
};

constexpr const char* upright_body =
    "a body that stands upright, in one piece, with a head, two arms and two legs that are apart from each other";

[[noreturn]] void refuse(const InputPlace& place, const std::string& found)
{
    throw InputError(place, found, upright_body);
}

double height_of(const Skin& skin, int vertex) { return skin.vertices[vertex].z(); }

struct Extent {
    double low = 0, size = 0;
    double share(double z) const { return (z - low) / size; }
};

// Below, left and right are not told apart yet: {one, other}.
struct Roles {
    std::array<Branch, 2> arms, legs;
    int crotch = 0;
};

std::string counted_tips(std::size_t count)
{
    return count == 1 ? "one end of a limb" : fmt::format("{} ends of limbs", count);
}

Roles roles_of(const Skin& skin, const Extent& height, std::vector<Branch> branches, const InputPlace& place)
{
    if (branches.size() < 4)
        refuse(place,
               fmt::format("a shape with {} below its highest point, but a body has 4", counted_tips(branches.size())));
    std::sort(branches.begin(), branches.end(),
              [&](const Branch& a, const Branch& b) { return height_of(skin, a.tip) < height_of(skin, b.tip); });
    Roles roles;
    std::copy_n(branches.begin(), 2, roles.legs.begin());
    branches.erase(branches.begin(), branches.begin() + 2);
    std::sort(branches.begin(), branches.end(),
              [](const Branch& a, const Branch& b) { return a.persistence > b.persistence; });
    std::copy_n(branches.begin(), 2, roles.arms.begin());
    for (const Branch& leg : roles.legs)
        if (const double at = height.share(height_of(skin, leg.tip)); at > LimbLimits::foot_top)
            refuse(place, fmt::format(
                              "no two feet on the ground: the second lowest end of a limb is at {:.0f} % of the height",
                              100 * at));
    for (const Branch& arm : roles.arms)
        if (const double at = height.share(height_of(skin, arm.tip)); at < LimbLimits::hand_bottom)
            refuse(place, fmt::format("no hands: more than two limbs end below {:.0f} % of the height",
                                      100 * LimbLimits::hand_bottom));
    const Branch& shorter = roles.legs[0].into == roles.legs[1].tip ? roles.legs[0] : roles.legs[1];
    if (shorter.saddle < 0 || shorter.into != (&shorter == &roles.legs[0] ? roles.legs[1] : roles.legs[0]).tip)
        refuse(place, "no crotch: the two limbs that reach the ground do not meet each other first");
    roles.crotch = shorter.saddle;
    return roles;
}

void examine_heights(const Skin& skin, const Extent& height, const Roles& roles, const InputPlace& place)
{
    const double crotch = height.share(height_of(skin, roles.crotch));
    if (crotch < LimbLimits::crotch_low || crotch > LimbLimits::crotch_high)
        refuse(place, fmt::format("legs that meet at {:.1f} % of the height (expected {:.0f} to {:.0f} %)",
                                  100 * crotch, 100 * LimbLimits::crotch_low, 100 * LimbLimits::crotch_high));
    for (const Branch& arm : roles.arms) {
        if (arm.saddle < 0) refuse(place, "no armpits: the limbs at the sides are the longest");
        const double armpit = height.share(height_of(skin, arm.saddle));
        if (armpit < LimbLimits::armpit_low || armpit > LimbLimits::armpit_high || armpit < crotch)
            refuse(place,
                   fmt::format("an arm that meets the trunk at {:.1f} % of the height (expected {:.0f} to {:.0f} %)",
                               100 * armpit, 100 * LimbLimits::armpit_low, 100 * LimbLimits::armpit_high));
    }
}

bool beyond_an_armpit(const Limbs& limbs, std::size_t vertex)
{
    bool on_arm = false;
    for (int k = 0; k < 2; ++k) on_arm |= limbs.from_hand[k][vertex] < limbs.from_hand[k][limbs.armpits[k]];
    return on_arm;
}

struct Torso {
    Vec3 middle = Vec3::Zero(), side = Vec3::UnitX();  ///< Horizontal axis from side to side.
};

// The angle of a direction from an axis, whichever way it points, seen from above [rad].
double angle_from(const Vec2& axis, Vec2 direction)
{
    if (direction.dot(axis) < 0) direction = -direction;
    return std::atan2(axis.x() * direction.y() - axis.y() * direction.x(), axis.dot(direction));
}

// The axis from side to side is the middle one of three: between the armpits, between the fingertips, and the longer
// axis of the torso's section. Each of them is off on some bodies: by a few degrees, or far where one arm is raised.
Torso torso_of(const Skin& skin, const Extent& height, const Limbs& limbs)
{
    const double low = skin.vertices[limbs.crotch].z() + 0.05 * height.size;
    const double high = std::min(height_of(skin, limbs.armpits[0]), height_of(skin, limbs.armpits[1]));
    double area = 0;
    Vec2 first = Vec2::Zero();
    Mat2 second = Mat2::Zero();
    for (std::size_t v = 0; v < skin.vertices.size(); ++v) {
        const Vec3& x = skin.vertices[v];
        if (beyond_an_armpit(limbs, v) || x.z() < low || x.z() > high) continue;
        area += skin.area[v];
        first += skin.area[v] * x.head<2>();
        second += skin.area[v] * x.head<2>() * x.head<2>().transpose();
    }
    const auto across = [&](const std::array<int, 2>& pair) {
        return Vec2((skin.vertices[pair[0]] - skin.vertices[pair[1]]).head<2>());
    };
    const Vec2 armpits = across(limbs.armpits).normalized();
    Torso torso;
    torso.side = Vec3(armpits.x(), armpits.y(), 0);
    if (!(area > 0)) return torso;
    const Vec2 middle = first / area;
    torso.middle.head<2>() = middle;
    const Eigen::SelfAdjointEigenSolver<Mat2> axes(second / area - middle * middle.transpose());
    if (axes.eigenvalues()[1] < LimbLimits::least_flatness * axes.eigenvalues()[0]) return torso;
    std::array<double, 3> turns{0, angle_from(armpits, across(limbs.hand_tips)),
                                angle_from(armpits, axes.eigenvectors().col(1))};
    std::sort(turns.begin(), turns.end());
    torso.side = Eigen::AngleAxisd(turns[1], Vec3::UnitZ()) * torso.side;
    return torso;
}

// How much further the feet reach to one side of the ankles than to the other, from -1 to 1.
double reach_of_feet(const Skin& skin, const Extent& height, const Limbs& limbs, const Vec3& direction)
{
    double before = 0, behind = 0;
    for (int k = 0; k < 2; ++k) {
        const auto on_leg = [&](std::size_t v) { return limbs.from_foot[k][v] < limbs.from_foot[k][limbs.crotch]; };
        double area = 0, ankle = 0, most = -1e9, least = 1e9;
        for (std::size_t v = 0; v < skin.vertices.size(); ++v) {
            const double at = height.share(skin.vertices[v].z()), along = skin.vertices[v].dot(direction);
            if (!on_leg(v)) continue;
            if (at > LimbLimits::ankle_low && at < LimbLimits::ankle_high) {
                area += skin.area[v];
                ankle += skin.area[v] * along;
            }
            if (at < LimbLimits::foot_height) {
                most = std::max(most, along);
                least = std::min(least, along);
            }
        }
        if (!(area > 0) || most < least) continue;
        before += std::max(most - ankle / area, 0.0);
        behind += std::max(ankle / area - least, 0.0);
    }
    return before + behind > 0 ? (before - behind) / (before + behind) : 0;
}

// How far the head lies before the top of the trunk, over the height: necks lean forward.
double reach_of_head(const Skin& skin, const Extent& height, const Limbs& limbs, const Vec3& direction)
{
    const double armpits = height.share((height_of(skin, limbs.armpits[0]) + height_of(skin, limbs.armpits[1])) / 2);
    std::array<double, 2> area{}, along{};  // of the head, of the trunk
    for (std::size_t v = 0; v < skin.vertices.size(); ++v) {
        const double at = height.share(skin.vertices[v].z());
        const bool head = at > LimbLimits::head_bottom;
        if (beyond_an_armpit(limbs, v) || (!head && (at < armpits || at > armpits + LimbLimits::trunk_top))) continue;
        area[head ? 0 : 1] += skin.area[v];
        along[head ? 0 : 1] += skin.area[v] * skin.vertices[v].dot(direction);
    }
    return area[0] > 0 && area[1] > 0 ? (along[0] / area[0] - along[1] / area[1]) / height.size : 0;
}

void swap_sides(Limbs& limbs)
{
    std::swap(limbs.hand_tips[0], limbs.hand_tips[1]);
    std::swap(limbs.armpits[0], limbs.armpits[1]);
    std::swap(limbs.from_hand[0], limbs.from_hand[1]);
}

}  // namespace

Vec3 BodyFrame::to_body(const Vec3& in_file) const
{
    return Eigen::AngleAxisd(azimuth, Vec3::UnitZ()) * (in_file - origin);
}

Vec3 BodyFrame::to_file(const Vec3& in_body) const
{
    return Eigen::AngleAxisd(-azimuth, Vec3::UnitZ()) * in_body + origin;
}

Limbs find_limbs(const Skin& skin, const InputPlace& place)
{
    if (skin.faces.empty()) refuse(place, "a mesh without area");
    if (skin.area_share < LimbLimits::least_share)
        refuse(place,
               fmt::format("loose pieces, the largest of which has {:.0f} % of the area", 100 * skin.area_share));
    const auto [lowest, highest] = std::minmax_element(skin.vertices.begin(), skin.vertices.end(),
                                                       [](const Vec3& a, const Vec3& b) { return a.z() < b.z(); });
    const Extent height{lowest->z(), highest->z() - lowest->z()};
    Limbs limbs;
    limbs.crown = int(highest - skin.vertices.begin());
    const std::vector<double> from_crown = geodesic_distances(skin, {{limbs.crown, 0}});
    const double longest = *std::max_element(from_crown.begin(), from_crown.end());
    const Roles roles = roles_of(skin, height, merge_tree(skin, from_crown, LimbLimits::persistence * longest), place);
    examine_heights(skin, height, roles, place);
    limbs.crotch = roles.crotch;
    for (int k = 0; k < 2; ++k) {
        limbs.hand_tips[k] = roles.arms[k].tip;
        limbs.armpits[k] = roles.arms[k].saddle;
        limbs.foot_tips[k] = roles.legs[k].tip;
        limbs.from_hand[k] = geodesic_distances(skin, {{limbs.hand_tips[k], 0}});
        limbs.from_foot[k] = geodesic_distances(skin, {{limbs.foot_tips[k], 0}});
    }

    Torso torso = torso_of(skin, height, limbs);
    const Vec3 front = torso.side.cross(Vec3::UnitZ());
    const double feet = reach_of_feet(skin, height, limbs, front);
    const double head = reach_of_head(skin, height, limbs, front);
    const bool have_feet = std::abs(feet) > LimbLimits::least_foot;
    if (!have_feet && std::abs(head) < LimbLimits::least_lean)
        refuse(place, "no front: neither do the feet reach further to one side of the ankles, nor does the neck lean");
    if ((have_feet ? feet : head) < 0) {  // `side` runs from right to left when the front is side x up
        torso.side = -torso.side;
        swap_sides(limbs);
    }
    limbs.frame.azimuth = -std::atan2(torso.side.y(), torso.side.x());
    limbs.frame.origin = Vec3(torso.middle.x(), torso.middle.y(), height.low);
    const auto leftness = [&](int vertex) { return skin.vertices[vertex].dot(torso.side); };
    if (leftness(limbs.foot_tips[0]) < leftness(limbs.foot_tips[1])) {
        std::swap(limbs.foot_tips[0], limbs.foot_tips[1]);
        std::swap(limbs.from_foot[0], limbs.from_foot[1]);
    }
    return limbs;
}

}  // namespace selvage
