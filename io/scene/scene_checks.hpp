#pragma once
#include "io/scene/scene.hpp"

namespace selvage {

/// Checks what no single key can tell: that there is cloth, that files exist, that values fit each other.
/// @throws InputError for the first fault.
void check_scene(const Scene& scene);

/// Adds every fabric that the garment or a sheet names and the scene does not define itself.
/// @throws InputError naming the nearest fabric.
void resolve_fabrics(Scene& scene);

}  // namespace selvage
