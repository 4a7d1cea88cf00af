#include "validation/cases/report.hpp"

#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace selvage {
namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();

double relative_error(double reference, double measured)
{
    return std::abs(measured - reference) / std::abs(reference);
}

}  // namespace

void CaseReport::relative(const std::string& quantity, double reference, double measured, double tolerance)
{
    judge(quantity, reference, measured, relative_error(reference, measured), tolerance);
}

void CaseReport::absolute(const std::string& quantity, double reference, double measured, double tolerance)
{
    judge(quantity, reference, measured, std::abs(measured - reference), tolerance);
}

void CaseReport::judge(const std::string& quantity, double reference, double measured, double error, double tolerance)
{
    rows_.push_back({group_, quantity, reference, measured, error, tolerance, error <= tolerance, source_});
}

void CaseReport::inform(const std::string& quantity, double reference, double measured)
{
    rows_.push_back({group_, quantity, reference, measured, relative_error(reference, measured), none, true, source_});
}

void CaseReport::fail(const std::string& reason)
{
    rows_.push_back({group_, "ended with: " + reason, none, none, none, 0, false, source_});
}

std::string validation_table(const std::vector<ValidationRow>& rows)
{
    std::size_t widest = 8;
    for (const ValidationRow& row : rows) widest = std::max(widest, row.quantity.size());
    std::string text = fmt::format("{:<12} {:<{}} {:>14} {:>14} {:>9} {:>9}  verdict\n", "case", "quantity", widest,
                                   "reference", "measured", "error", "tolerance");
    int judged = 0, passed = 0;
    for (const ValidationRow& row : rows) {
        judged += row.judged();
        passed += row.judged() && row.pass;
        text += fmt::format("{:<12} {:<{}} {:>14.8g} {:>14.8g} {:>9.2e} {:>9}  {}\n", row.group, row.quantity, widest,
                            row.reference, row.measured, row.error,
                            row.judged() ? fmt::format("{:.1e}", row.tolerance) : "-",
                            !row.judged() ? "information"
                            : row.pass    ? "pass"
                                          : "FAIL");
    }
    return text + fmt::format("{} of {} pass, {} rows are information\n", passed, judged, int(rows.size()) - judged);
}

std::string validation_json(const std::vector<ValidationRow>& rows)
{
    nlohmann::ordered_json cases = nlohmann::ordered_json::array();
    const auto number = [](double value) { return std::isfinite(value) ? nlohmann::ordered_json(value) : nullptr; };
    for (const ValidationRow& row : rows)
        cases.push_back({{"case", row.group},
                         {"quantity", row.quantity},
                         {"reference", number(row.reference)},
                         {"measured", number(row.measured)},
                         {"error", number(row.error)},
                         {"tolerance", number(row.tolerance)},
                         {"pass", row.pass},
                         {"source", row.source}});
    return nlohmann::ordered_json{{"cases", cases}}.dump(2);
}

}  // namespace selvage
