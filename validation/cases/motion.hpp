#pragma once
#include <string>

#include "validation/cases/report.hpp"
#include "validation/measure/timed_motion.hpp"

namespace selvage {

inline constexpr double motion_gravity = 9.81;  ///< [m/s^2]

/// The keys of an isotropic fabric `f` without damping and friction, as TOML.
/// @param stretch  [N/m]   @param bending  [N m]   @param density  [kg/m^2]
std::string motion_fabric(double stretch, double bending, double density);

// For the names of rows: N/m, s.
std::string stiffness_name(double stretch);
std::string step_name(double step);

/// Adds rows of how far accepted steps are from what they are to solve, and of what the program says of that.
void judge_missed(CaseReport& report, const std::string& name, const MissedSteps& missed);

// Parts of check_motion.
void rigid_fall(CaseReport& report);
void rigid_spin(CaseReport& report);
void leaning_card(CaseReport& report);

}  // namespace selvage
