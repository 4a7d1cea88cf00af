#pragma once
#include <string>

#include "io/choices.hpp"
#include "io/pattern/pattern.hpp"

namespace selvage {

/// What a file in this format leaves open.
struct PatternConventions {
    PatternAxis up = PatternAxis::automatic;  ///< Up direction; automatic: y.
    RotationOrder rotation_order = RotationOrder::xyz;
    bool order_is_given = false;  ///< The user chose the order: nothing need be said about it.
};

/// Reads a sewing pattern in GarmentCode's JSON format (Korosteleva and Sorkine-Hornung 2023).
/// A panel's point p goes to R p + t, with R = Rz Ry Rx by default. Lengths become metres and the up direction z;
/// `garment.translation` is not applied here; the caller applies it, because it also moves built-in patterns.
/// @throws InputError with a key path such as `pattern.panels.front.edges[3].endpoints` for the first fault.
Pattern read_pattern_json(const std::string& path, const PatternConventions& conventions);

}  // namespace selvage
