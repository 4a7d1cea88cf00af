#pragma once
#include <string>
#include <vector>

namespace selvage {

/// One sheet with one feature in one state.
struct SkipCase {
    std::string feature, state;  ///< State: absent, idle or active.
    std::string scene;           ///< TOML file.
    std::string trace;           ///< Phase that a profile shows only if the feature is in use.
};

/// Returns all cases; the first case of each feature is the one in which it is absent. A feature is idle if it is
/// declared but has nothing to do. The sheet hangs without folds, so its contact with itself is idle at most. Sleep has
/// a scene of its own, in which most of the cloth is at rest.
/// @param resolution  vertices per side
/// @param until       simulated time [s]
/// @param folder      where the scenes are written
std::vector<SkipCase> skip_cases(int resolution, double until, const std::string& folder);

}  // namespace selvage
