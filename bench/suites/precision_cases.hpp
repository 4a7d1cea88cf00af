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
    bool at_rest = false;       ///< Only the shape at rest counts.
    double reference_step = 0;  ///< Of a motion's reference [s]; 0: an eighth of the limit at the start.
    int most_steps = 0;         ///< Into which implicit schemes divide a motion; 0: 64 if quick, else 256.
};

/// One run: a point of the diagram.
struct PrecisionPoint {
    std::string scene, integrator;
    RunSetting setting;
    RunResult result;
    double error = 0;  ///< See position_error [1].
};

/// What errors are measured against, and how far it is itself from being right.
struct PrecisionReference {
    std::vector<Vec3> positions, other;  ///< Of two different integrators; the second judges the first one's points.
    std::string integrator, other_integrator;
    double step = 0;            ///< Asked of both [s].
    double refined_change = 0;  ///< Error of the reference at twice the step [1].
    double difference = 0;      ///< Between the two [1].
    double seconds = 0;         ///< That finding it took.
};

/// The scenes, or the named one.
/// @throws InputError for an unknown name
std::vector<PrecisionScene> precision_scenes(const std::string& name);

/// Finds the reference of a scene with steps far below the stability limit.
PrecisionReference find_reference(SceneRunner& runner, const PrecisionScene& scene);

/// The settings that are tried on a scene. @param limit  stability limit of symplectic Euler at the start [s]
std::vector<RunSetting> precision_settings(const PrecisionScene& scene, double until, double limit, bool quick);

}  // namespace selvage
