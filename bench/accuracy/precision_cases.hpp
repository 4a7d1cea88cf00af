#pragma once
#include <functional>
#include <string>
#include <vector>

#include "bench/harness/scene_runner.hpp"

namespace selvage {

/// A scene whose error is measured.
struct PrecisionScene {
    std::string name, title, source;
    std::vector<std::string> overrides;
    bool at_rest = false;       ///< The error is that of the shape at rest, not of a motion.
    double reference_step = 0;  ///< Step of a motion's reference [s]; 0: an eighth of the stability limit at the start.
    int most_steps = 0;         ///< Largest number of steps of implicit schemes; 0: 64 if quick, else 256.
};

/// One run, which is one point of the diagram.
struct PrecisionPoint {
    std::string scene;
    std::string method;  ///< See method_name.
    RunSetting setting;
    RunResult result;
    double error = 0;  ///< See position_error [1].
};

/// The reference solution that errors are measured against, with estimates of its own error.
struct PrecisionReference {
    std::vector<Vec3> positions, other;  ///< By two integrators; the second is the reference for runs of the first.
    std::string integrator, other_integrator;
    double step = 0;            ///< Step of both [s].
    double refined_change = 0;  ///< Change of the first from twice the step, or from ten times the tolerance [1].
    double difference = 0;      ///< Difference between the two [1].
    double seconds = 0;         ///< Wall time of finding the reference [s].
};

/// Returns the name of an integrator with fixed or with adaptive steps.
std::string method_name(std::string_view integrator, bool adaptive);

/// Returns all scenes of the suite, or the named one.
/// @throws InputError for an unknown name
std::vector<PrecisionScene> precision_scenes(const std::string& name);

/// Finds the reference of a scene with steps far below the stability limit.
PrecisionReference find_reference(SceneRunner& runner, const PrecisionScene& scene);

/// Returns the settings that are tried on a scene.
/// @param until  end time of a motion [s]
/// @param limit  stability limit of symplectic Euler at the start [s]
/// @param quick  fewer settings
std::vector<RunSetting> precision_settings(const PrecisionScene& scene, double until, double limit, bool quick);

}  // namespace selvage
