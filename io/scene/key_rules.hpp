#pragma once
#include <string>
#include <vector>

#include "io/scene/scene.hpp"

namespace selvage {

/// Looks at every key that a scene gives and that counts under some condition only, such as the radius of a sheet that
/// is no disc. What decides may come from the command line and the key from the file: then the key has been overruled.
/// @returns the paths of keys that are overruled, which the scene is better without
/// @throws InputError at the first other key that does nothing where it stands, with what it needs
std::vector<std::string> overruled_keys(const Scene& scene);

}  // namespace selvage
