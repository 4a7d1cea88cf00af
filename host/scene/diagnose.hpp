#pragma once
#include <string>

#include "io/scene/scene.hpp"

namespace selvage {

/// What was found wrong with a scene before it runs.
struct Diagnosis {
    bool clean = true;  ///< Nothing was found that would spoil the run.
    std::string text;   ///< For a person; ends in a newline.
    std::string json;   ///< The same for a program; ends in a newline.
};

/// Looks for cloth that starts inside a body or through it or through itself, bad triangles and lengths that look like
/// a slip of unit.
/// @param picture_path  when not empty, the scene as it starts is drawn there with the faulty faces highlighted
/// @throws InputError for faults that stop a run from starting
Diagnosis diagnose_scene(const Scene& scene, const std::string& picture_path);

}  // namespace selvage
