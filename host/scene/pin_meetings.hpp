#pragma once
#include <optional>

#include "host/model/cloth.hpp"
#include "io/finding.hpp"
#include "io/scene/scene.hpp"

namespace selvage {

/// Looks for held vertices that are driven against each other, so that the cloth between them has no room: the first
/// pair that comes nearer than contact allows, or than half an edge, though it starts further apart.
std::optional<Finding> find_meeting_pins(const Cloth& cloth, const Scene& scene);

}  // namespace selvage
