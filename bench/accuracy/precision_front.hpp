#pragma once
#include <optional>
#include <string>
#include <vector>

#include "bench/accuracy/precision_cases.hpp"

namespace selvage {

/// The Pareto front of one method: run time and error of its points that no other of its points beats in both.
struct PrecisionFront {
    std::string method;                  ///< See method_name.
    std::vector<double> seconds, error;  ///< CPU time [s], increasing, and error [1], decreasing.
};

/// Returns the fronts of one scene in the order of integrators(), without methods that finished no run.
std::vector<PrecisionFront> fronts(const std::vector<PrecisionPoint>& points, const std::string& scene);

/// Returns the CPU time that a method needs for an error [s], by linear interpolation of the logarithms between
/// two points; nothing if no point is as accurate.
std::optional<double> time_for_error(const PrecisionFront& front, double error);

/// Says in one sentence which method is the fastest at 10, 1 and 0.1 % error, and what the default needs for 1 %.
/// @param standard  name of the default method
std::string verdict_sentence(const std::vector<PrecisionFront>& fronts, const std::string& scene,
                             const std::string& standard);

}  // namespace selvage
