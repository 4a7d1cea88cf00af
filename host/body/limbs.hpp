#pragma once
#include <array>
#include <vector>

#include "host/body/skin.hpp"
#include "io/errors.hpp"

namespace selvage {

/// Which way a body stands in its file: z is up in both.
struct BodyFrame {
    double azimuth = 0;  ///< The file's axes turned about z by this give the body's: it faces -y, left is +x [rad].
    Vec3 origin = Vec3::Zero();  ///< Below the middle of the torso, at the lowest point [m].

    Vec3 to_body(const Vec3& in_file) const;
    Vec3 to_file(const Vec3& in_body) const;
};

/// The limbs of a body, pairs as {left, right} of the wearer. Vertices are those of the skin.
struct Limbs {
    int crown = 0;
    std::array<int, 2> hand_tips{}, armpits{}, foot_tips{};
    int crotch = 0;
    std::array<std::vector<double>, 2> from_hand, from_foot;  ///< Geodesic distance from the tips [m].
    BodyFrame frame;
};

/// Finds the limbs of a body of any pose in which it stands, with z up: the tips of limbs are maxima of the geodesic
/// distance from the crown, armpits and crotch are its saddles (Hilaga and others 2001, with the persistence of
/// Edelsbrunner, Letscher and Zomorodian 2002). The feet tell the front; without feet, the neck, which leans to it.
/// @param place  the body in the user's input, for messages
/// @throws InputError that says what was not found if this is no body with two arms and two legs
Limbs find_limbs(const Skin& skin, const InputPlace& place);

}  // namespace selvage
