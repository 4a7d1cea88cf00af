#pragma once
#include <string_view>
#include <vector>

#include "io/scene/scene.hpp"

namespace selvage {

/// Returns the indices of a list such as "0, 4"; none of an empty one.
/// @param place  of the key, for messages
/// @throws InputError for anything but whole numbers from 0, separated by commas
std::vector<int> listed_indices(std::string_view list, const InputPlace& place);

/// Checks what the tables of elastic say by themselves.
/// @throws InputError at one that names no panel or no edges
void check_elastics(const Scene& scene);

/// Checks what the tables of pins say by themselves; panels and vertices are looked up when the cloth is there.
/// @throws InputError at pins that name no cloth, or more than one where one is meant, and at motions that cannot be
void check_pins(const Scene& scene);

}  // namespace selvage
