#pragma once
#include <string>

#include "io/pattern/pattern.hpp"
#include "io/scene/scene.hpp"

namespace selvage {

/// Reads a sewing pattern in GarmentCode's JSON format (Korosteleva and Sorkine-Hornung 2023).
/// A panel's point p goes to R p + t, with R = Rz Ry Rx by default. Lengths become metres and the up direction z;
/// `garment.translation` is not applied here; the caller applies it, because it also moves built-in patterns.
/// @param garment  its `up_axis` and `rotation_order` are used
/// @throws InputError with a key path such as `pattern.panels.front.edges[3].endpoints` for the first fault.
Pattern read_pattern_json(const std::string& path, const GarmentScene& garment);

}  // namespace selvage
