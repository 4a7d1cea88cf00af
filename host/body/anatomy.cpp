#include "host/body/anatomy.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace selvage {
namespace {

/// Over the height, but for the slope and the count.
struct LimbRoots {
    static constexpr double groin_slope = 0.5;  // chosen by the segmentation that comes with GarmentCode's mean body
    // How much further from the hand than the armpit the top of the shoulder can lie.
    static constexpr double over_shoulder = 0.15;
    static constexpr double ring_half = 0.01, upper_arm = 0.08;  // of the rings that give an arm's direction
    // From the shoulder's joint to the skin of the armpit: GarmentCode's mean body in A and in T pose then has its
    // shoulders equally wide, within 4 %.
    static constexpr double armpit_radius = 0.06;
    // Sagittal sections around the vertex of the crotch, and how far from it the crotch may be found.
    static constexpr double saddle_step = 0.0015, saddle_reach = 0.03, saddle_change = 0.008;
    static constexpr int saddle_planes = 10;  // to either side
};

double reach_of_arm(const Anatomy& body, int side) { return body.limbs.from_hand[side][body.limbs.armpits[side]]; }

// The middle of the ring of skin at a distance from the tip of a hand.
Vec3 middle_of_arm(const Anatomy& body, int side, double from_hand)
{
    double area = 0;
    Vec3 sum = Vec3::Zero();
    for (std::size_t v = 0; v < body.skin.vertices.size(); ++v) {
        if (std::abs(body.limbs.from_hand[side][v] - from_hand) > LimbRoots::ring_half * body.height) continue;
        area += body.skin.area[v];
        sum += body.skin.area[v] * body.skin.vertices[v];
    }
    return area > 0 ? Vec3(sum / area) : sum;
}

// 45 degrees for an arm that has no direction.
double drop_of_arm(const Anatomy& body, int side)
{
    const double reach = reach_of_arm(body, side), piece = LimbRoots::upper_arm * body.height;
    const Vec3 along = middle_of_arm(body, side, reach - piece) - middle_of_arm(body, side, reach);
    return along.norm() > 0 ? std::asin(std::clamp(-along.z() / along.norm(), -1.0, 1.0)) : M_PI / 4;
}

// The skin of the armpit follows a raised arm: it lies on the line that halves the angle between arm and trunk. What
// that moves it outwards from where it is with the arm at 45 degrees is taken back. Below, it hardly moves.
double shoulder_plane(const Anatomy& body, int side)
{
    const double from_hanging = M_PI / 2 - body.arm_drop[side];
    const double moved =
        LimbRoots::armpit_radius * body.height * std::max(std::sin(from_hanging / 2) - std::sin(M_PI / 8), 0.0);
    return std::abs(body.armpits[side].x()) - moved;
}

bool on_arm(const Anatomy& body, int side, int vertex)
{
    const Vec3& x = body.at(vertex);
    const double from_hand = body.limbs.from_hand[side][vertex], reach = reach_of_arm(body, side);
    if (x.z() < body.armpits[side].z()) return from_hand < reach;
    return (side == 0 ? x.x() : -x.x()) > body.shoulders[side] &&
           from_hand < reach + LimbRoots::over_shoulder * body.height;
}

// Where the legs meet lies the highest of the lowest points of sagittal sections near the saddle, which is a vertex
// only.
Vec3 crotch_near(const Anatomy& body, const Vec3& saddle)
{
    const double step = LimbRoots::saddle_step * body.height, reach = LimbRoots::saddle_reach * body.height;
    const FaceMask all(body.skin.faces.size(), 1);
    std::optional<Vec3> highest;
    for (int k = -LimbRoots::saddle_planes; k <= LimbRoots::saddle_planes; ++k) {
        std::optional<Vec3> lowest;
        for (const Vec3& point : section(body.skin, all, saddle + k * step * Vec3::UnitX(), Vec3::UnitX()))
            if ((point - saddle).norm() < reach && (!lowest || point.z() < lowest->z())) lowest = point;
        if (lowest && (!highest || lowest->z() > highest->z())) highest = lowest;
    }
    // Thighs that reach over the middle are cut as well: then there is no such point near the vertex.
    return highest && std::abs(highest->z() - saddle.z()) < LimbRoots::saddle_change * body.height ? *highest : saddle;
}

bool below_groin(const Anatomy& body, const Vec3& x)
{
    return x.z() < body.crotch + LimbRoots::groin_slope * std::abs(x.x());
}

BodyRegion coarse_region(const Anatomy& body, int vertex)
{
    if (on_arm(body, 0, vertex)) return BodyRegion::left_arm;
    if (on_arm(body, 1, vertex)) return BodyRegion::right_arm;
    if (!below_groin(body, body.at(vertex))) return BodyRegion::torso;
    const bool left = body.limbs.from_foot[0][vertex] < body.limbs.from_foot[1][vertex];
    return left ? BodyRegion::left_leg : BodyRegion::right_leg;
}

void mask_faces(Anatomy& body)
{
    const std::size_t count = body.skin.faces.size();
    body.trunk.assign(count, 1);
    for (int side = 0; side < 2; ++side) {
        body.arms[side].assign(count, 1);
        body.legs[side].assign(count, 1);
        body.halves[side].assign(count, 0);
    }
    const std::array<BodyRegion, 2> arm{BodyRegion::left_arm, BodyRegion::right_arm};
    const std::array<BodyRegion, 2> leg{BodyRegion::left_leg, BodyRegion::right_leg};
    for (std::size_t f = 0; f < count; ++f)
        for (const int v : body.skin.faces[f]) {
            const BodyRegion region = body.regions[v];
            for (int side = 0; side < 2; ++side) {
                if (region == arm[side]) body.trunk[f] = 0;
                if (region != arm[side]) body.arms[side][f] = 0;
                if (region != leg[side]) body.legs[side][f] = 0;
                if ((body.at(v).x() > 0) == (side == 0)) body.halves[side][f] = 1;
            }
        }
}

}  // namespace

Anatomy make_anatomy(Skin skin, const InputPlace& place)
{
    Anatomy body;
    body.limbs = find_limbs(skin, place);
    body.skin = std::move(skin);
    for (Vec3& x : body.skin.smooth) x = body.limbs.frame.to_body(x);
    for (Vec3& x : body.skin.vertices) {
        x = body.limbs.frame.to_body(x);
        body.height = std::max(body.height, x.z());
    }
    body.crotch_point = crotch_near(body, body.at(body.limbs.crotch));
    body.crotch = body.crotch_point.z();
    for (int side = 0; side < 2; ++side) body.armpits[side] = body.at(body.limbs.armpits[side]);
    for (int side = 0; side < 2; ++side) {
        body.arm_drop[side] = drop_of_arm(body, side);
        body.shoulders[side] = shoulder_plane(body, side);
    }
    body.regions.resize(body.skin.vertices.size());
    for (int v = 0; v < int(body.regions.size()); ++v) body.regions[v] = coarse_region(body, v);
    mask_faces(body);
    return body;
}

}  // namespace selvage
