#pragma once
#include <optional>
#include <string>
#include <vector>

#include "bench/suites/precision_cases.hpp"

namespace selvage {

/// Where an integrator does best: run time and error of those of its points that no other of its points beats in both.
struct PrecisionFront {
    std::string integrator;
    std::vector<double> seconds, error;  ///< Rising CPU time [s], falling error [1].
};

/// The fronts of one scene, in the order of integrators(); without those that never finished.
std::vector<PrecisionFront> fronts(const std::vector<PrecisionPoint>& points, const std::string& scene);

/// The time that an error takes, between two points on a straight line through their logarithms [s]; nothing if no
/// point is as accurate.
std::optional<double> time_for_error(const PrecisionFront& front, double error);

/// One sentence: which integrator is the fastest at 10, 1 and 0.1 % error, and what the default takes at 1 %.
std::string verdict_sentence(const std::vector<PrecisionFront>& fronts, const std::string& scene,
                             const std::string& standard);

}  // namespace selvage
