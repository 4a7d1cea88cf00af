#include "host/body/anatomy.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace selvage {
namespace {

// Chosen by the segmentation that comes with GarmentCode's mean body.
constexpr double groin_slope = 0.5;
// How much further from the hand than the armpit the top of the shoulder can lie, over the height.
constexpr double over_shoulder = 0.15;
constexpr double ring_half = 0.01, upper_arm = 0.08;  // of the rings that give an arm's direction, over the height
// From the shoulder's joint to the skin of the armpit, over the height: GarmentCode's mean body in A and in T pose then
// has its shoulders equally wide.
constexpr double armpit_radius = 0.06;

double reach_of_arm(const Anatomy& body, int side) { return body.limbs.from_hand[side][body.limbs.armpits[side]]; }

// The middle of the ring of skin at a distance from the tip of a hand.
Vec3 middle_of_arm(const Anatomy& body, int side, double from_hand)
{
    double area = 0;
    Vec3 sum = Vec3::Zero();
    for (std::size_t v = 0; v < body.skin.vertices.size(); ++v) {
        if (std::abs(body.limbs.from_hand[side][v] - from_hand) > ring_half * body.height) continue;
        area += body.skin.area[v];
        sum += body.skin.area[v] * body.skin.vertices[v];
    }
    return area > 0 ? Vec3(sum / area) : sum;
}

// The skin of the armpit follows a raised arm: it lies on the line that halves the angle between arm and trunk. What
// that moves it outwards from where it is with the arm at 45 degrees is taken back. Below, it hardly moves.
double shoulder_plane(const Anatomy& body, int side)
{
    const double reach = reach_of_arm(body, side), piece = upper_arm * body.height;
    const Vec3 along = middle_of_arm(body, side, reach - piece) - middle_of_arm(body, side, reach);
    if (!(along.norm() > 0)) return std::abs(body.armpits[side].x());
    const double below = std::acos(std::clamp(-along.z() / along.norm(), -1.0, 1.0));  // angle from hanging down
    const double moved = armpit_radius * body.height * std::max(std::sin(below / 2) - std::sin(M_PI / 8), 0.0);
    return std::abs(body.armpits[side].x()) - moved;
}

bool on_arm(const Anatomy& body, int side, int vertex)
{
    const Vec3& x = body.at(vertex);
    const double from_hand = body.limbs.from_hand[side][vertex], reach = reach_of_arm(body, side);
    if (x.z() < body.armpits[side].z()) return from_hand < reach;
    return (side == 0 ? x.x() : -x.x()) > body.shoulders[side] && from_hand < reach + over_shoulder * body.height;
}

bool below_groin(const Anatomy& body, const Vec3& x) { return x.z() < body.crotch + groin_slope * std::abs(x.x()); }

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
    for (Vec3& x : body.skin.vertices) {
        x = body.limbs.frame.to_body(x);
        body.height = std::max(body.height, x.z());
    }
    body.crotch = body.at(body.limbs.crotch).z();
    for (int side = 0; side < 2; ++side) body.armpits[side] = body.at(body.limbs.armpits[side]);
    for (int side = 0; side < 2; ++side) body.shoulders[side] = shoulder_plane(body, side);
    body.regions.resize(body.skin.vertices.size());
    for (int v = 0; v < int(body.regions.size()); ++v) body.regions[v] = coarse_region(body, v);
    mask_faces(body);
    return body;
}

}  // namespace selvage
