#pragma once
#include <span>
#include <string>
#include <string_view>

#include "host/scene/scene_model.hpp"
#include "host/solver/terms/params.hpp"
#include "io/scene/scene.hpp"

namespace selvage {

/// What the features of a scene are decided for.
struct FeatureCase {
    const Scene& scene;
    const SceneModel& model;
    bool sewing;  ///< True: while seams are pulled closed; false: afterwards, or without seams.
};

/// One row of the table of features: all that a scene says about a force term, a velocity filter, or another part of a
/// run.
struct Feature {
    std::string_view name;  ///< Of a term, a velocity filter, or its own.
    /// Gives a term or velocity filter its parameters and returns nothing, or returns why the feature is off, which
    /// leaves its strengths zero. What is neither of these finds the parameters complete.
    std::string (*decide)(const FeatureCase&, Params&);
    bool is_listed = true;  ///< Among what is active, if it is on.
};

/// Returns the rows; those that are neither term nor velocity filter stand in the order in which the plan lists them.
/// A term or velocity filter without a row has the parameters that its kernel declares.
std::span<const Feature> all_features();

/// Tells whether a feature is a term or a velocity filter.
bool is_kernel(std::string_view feature);

/// Why a feature is off; empty: it is on. @param params  those of the case's phase
std::string why_off(const FeatureCase& with, std::string_view feature, const Params& params);

/// Why bodies are not made thin while a garment is sewn; empty: they are, where that is needed.
std::string why_no_thin_bodies(const Scene& scene, const SceneModel& model);

/// The parameters of every term and velocity filter in one phase of a scene; a strength of zero leaves a term out.
/// While seams are pulled closed there is no gravity and no friction, and panels resist bending more.
Params phase_params(const Scene& scene, const SceneModel& model, bool sewing);

}  // namespace selvage
