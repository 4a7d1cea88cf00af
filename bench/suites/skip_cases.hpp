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

/// All cases; the first of each feature is the one without it. Idle means: declared, with nothing to do.
/// The sheet hangs without folds, so that contact with itself is idle at most. Sleep is shown by a scene that mostly
/// rests.
/// @param resolution  vertices a side   @param until  simulated time [s]   @param folder  where scenes are written
std::vector<SkipCase> skip_cases(int resolution, double until, const std::string& folder);

}  // namespace selvage
