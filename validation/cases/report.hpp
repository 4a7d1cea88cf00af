#pragma once
#include <string>
#include <vector>

namespace selvage {

/// One compared quantity.
struct ValidationRow {
    std::string group, quantity;
    double reference = 0, measured = 0;
    double error = 0;
    double tolerance = 0;  ///< NaN: for information only, without a verdict.
    bool pass = true;
    std::string source;  ///< The source of the reference value.

    bool judged() const { return tolerance == tolerance; }
};

/// Collects the rows of one group of cases.
class CaseReport {
public:
    /// @param quick  cases should leave out their slow parts
    CaseReport(std::string group, bool quick) : group_(std::move(group)), quick_(quick) {}

    /// Sets the source of all rows that follow.
    void from(const std::string& source) { source_ = source; }
    /// Adds a row that passes if |measured - reference| <= tolerance |reference|.
    void relative(const std::string& quantity, double reference, double measured, double tolerance);
    /// Adds a row that passes if |measured - reference| <= tolerance.
    void absolute(const std::string& quantity, double reference, double measured, double tolerance);
    /// Adds a row with an error that the caller has computed; it passes if error <= tolerance.
    void judge(const std::string& quantity, double reference, double measured, double error, double tolerance);
    /// Adds a row with a relative error but without a verdict.
    void inform(const std::string& quantity, double reference, double measured);
    /// Adds a failing row for a case that ended with an exception.
    void fail(const std::string& reason);

    bool quick() const { return quick_; }
    const std::vector<ValidationRow>& rows() const { return rows_; }

private:
    std::string group_, source_;
    bool quick_;
    std::vector<ValidationRow> rows_;
};

/// Returns the rows as a table of text.
std::string validation_table(const std::vector<ValidationRow>& rows);

/// Returns the rows as JSON text: {"cases": [{case, quantity, reference, measured, error, tolerance, pass, source}]}.
/// The tolerance of a row without a verdict is null.
std::string validation_json(const std::vector<ValidationRow>& rows);

}  // namespace selvage
