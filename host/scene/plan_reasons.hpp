#pragma once
#include <cstddef>
#include <string>
#include <string_view>

#include "host/scene/scene_model.hpp"

namespace selvage {

/// Says why a term has no strength in any phase of a scene. @param term  its name in kernels/terms.h
std::string absence(const Scene& scene, const SceneModel& model, std::string_view term);

/// The same for terms and rules of contact. @param bodies  the scene has bodies
std::string absence_of_contact(const Scene& scene, bool bodies, std::string_view name);

/// How many of the coarser cloths a scene is draped on first, if it is: those above a longest edge for garments.
std::size_t levels_used(const Scene& scene, const SceneModel& model);

/// Says why a scene is not draped from coarse to fine; empty: it is.
/// Only shapes at rest may be reached on another way than the cloth would go, and only where the way leaves no trace.
std::string why_no_coarse_start(const Scene& scene, const SceneModel& model);

}  // namespace selvage
