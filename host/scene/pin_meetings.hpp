#pragma once
#include <optional>

#include "host/model/cloth.hpp"
#include "io/finding.hpp"
#include "io/scene/scene.hpp"

namespace selvage {

/// Looks for held vertices, edges and faces that are driven against each other, so that the cloth between them has no
/// room: the first pair that comes nearer than `gap` though it starts further apart. A note says so if there are too
/// many to be followed to the end.
/// @param gap  at which cloth presses on cloth [m]
std::optional<Finding> find_meeting_pins(const Cloth& cloth, const Scene& scene, double gap);

}  // namespace selvage
