#pragma once
#include <iosfwd>
#include <string>
#include <vector>

namespace selvage {

/// Runs every integrator over a grid of steps from 1e-5 to 0.1 s, stiffness from a hundredth to a hundred times
/// cotton's, 16 to 128 vertices per side and damping, from violent starts: crumpled, stretched by half, hurled at
/// 20 m/s. A cell should end stable, recovered by step control, or refused or given up with a message. It should never
/// hang, hold values that are not finite, or gain energy that no force supplied.
/// Then compares the measured stability limits of the explicit integrators with the predicted ones.
/// Options: `--output FOLDER` (default bench-out), `--quick 1` for the coarsest resolution only.
/// Writes stability.json, .csv and .png there and prints counts and limits, or the JSON.
/// @throws InputError for a bad option or a folder that cannot be written
void bench_stability(bool json, const std::vector<std::string>& options, std::ostream& out);

}  // namespace selvage
