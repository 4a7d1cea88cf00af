#pragma once
#include "io/scene/scene.hpp"

namespace selvage {

/// Checks what the tables of pins say by themselves; panels and vertices are looked up when the cloth is there.
/// @throws InputError at pins that name no cloth, or more than one where one is meant, and at motions that cannot be
void check_pins(const Scene& scene);

}  // namespace selvage
