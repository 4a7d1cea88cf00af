#pragma once
#include <array>
#include <string>
#include <vector>

#include "host/body/limbs.hpp"
#include "host/body/skin.hpp"
#include "host/body/tape.hpp"
#include "io/words.hpp"

namespace selvage {

#define BODY_REGIONS(WORD) \
    WORD(torso)            \
    WORD(neck)             \
    WORD(head)             \
    WORD(left_arm)         \
    WORD(right_arm)        \
    WORD(left_hand) WORD(right_hand) WORD(left_leg) WORD(right_leg) WORD(left_foot) WORD(right_foot) WORD(loose)

/// A part of a body; loose: a piece that is not joined to the skin.
WORD_ENUM(BodyRegion, BODY_REGIONS)

/// Where a skin's limbs begin: what every measure rests on. Pairs are {left, right} of the wearer.
struct Anatomy {
    Skin skin;  ///< In the body's own frame: it faces -y, left is +x, the ground is z = 0.
    Limbs limbs;
    double height = 0;                   ///< [m]
    Vec3 crotch_point = Vec3::Zero();    ///< Where the legs meet [m].
    double crotch = 0;                   ///< Its z [m].
    std::array<double, 2> shoulders;     ///< |x| of the sagittal plane in which each arm begins [m].
    std::array<Vec3, 2> armpits;         ///< [m]
    std::array<double, 2> arm_drop;      ///< Angle of each upper arm below the horizontal [rad].
    std::vector<BodyRegion> regions;     ///< Of each vertex: torso, arms and legs only.
    FaceMask trunk;                      ///< Faces that touch no arm: also legs and head.
    std::array<FaceMask, 2> arms, legs;  ///< Faces all of whose corners belong to it.
    std::array<FaceMask, 2> halves;      ///< Faces on either side of the middle.

    const Vec3& at(int vertex) const { return skin.vertices[vertex]; }
};

/// Divides a skin into trunk, arms and legs. An arm ends in a sagittal plane, that through the armpit if it is
/// held at 45 degrees, and below the armpit where the skin is further from the hand than the armpit is. Legs end at the
/// groin, which rises outwards from the crotch.
/// @throws InputError as find_limbs()
Anatomy make_anatomy(Skin skin, const InputPlace& place);

}  // namespace selvage
