#pragma once
#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

namespace selvage {

/// Returns the exponent b of y = a x^b by least squares of the logarithms; nothing with fewer than two different x.
std::optional<double> growth_exponent(const std::vector<double>& x, const std::vector<double>& y);

/// Drapes builtin:hanging, builtin:sphere, builtin:stress_stack and builtin:tshirt at increasing resolution, each run
/// in a process of its own, and prints time, memory, iterations and contacts against the number of vertices, with their
/// growth exponents.
/// Options: --scene NAME, --min-vertices N, --max-vertices N (by default 4 000 to 70 000), --threads N (by default 1
/// and all), --until equilibrium|SECONDS, --max-seconds S (of one run), --output FOLDER (scaling.csv, .json and .png),
/// --program FILE.
/// @throws InputError for a bad option
void bench_scaling(bool json, const std::vector<std::string>& options, std::ostream& out);

}  // namespace selvage
