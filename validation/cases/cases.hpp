#pragma once
#include <functional>
#include <string>
#include <vector>

#include "validation/cases/report.hpp"

namespace selvage {

/// A group of cases that are run together.
struct CaseGroup {
    std::string name, summary;
    void (*run)(CaseReport& report);
};

/// Returns all groups, in the order in which they run.
const std::vector<CaseGroup>& case_groups();

/// Called before and after each group, with a line for the user.
using CaseProgress = std::function<void(const std::string& line)>;

/// Runs groups and returns their rows. A group that throws gets a failing row.
/// @param names  empty: all
/// @param quick  leave out the slow parts
/// @throws InputError for an unknown name, naming the nearest
std::vector<ValidationRow> run_cases(const std::vector<std::string>& names, bool quick, const CaseProgress& progress);

// One source file each.
void check_stretch(CaseReport& report);
void check_terms(CaseReport& report);
void check_rigidity(CaseReport& report);
void check_cantilever(CaseReport& report);
void check_catenary(CaseReport& report);
void check_frequencies(CaseReport& report);
void check_buckling(CaseReport& report);
void check_motion(CaseReport& report);
void check_integrators(CaseReport& report);
void check_friction(CaseReport& report);
void check_wind(CaseReport& report);
void check_cusick(CaseReport& report);
void check_doubling(CaseReport& report);

}  // namespace selvage
