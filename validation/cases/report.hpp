#pragma once
#include <string>
#include <vector>

namespace selvage {

/// One compared quantity.
struct ValidationRow {
    std::string group, quantity;
    double reference = 0, measured = 0;
    double error = 0;
    double tolerance = 0;  ///< NaN: information only, there is no verdict.
    bool pass = true;
    std::string source;  ///< Where the reference comes from.

    bool judged() const { return tolerance == tolerance; }
};

/// Collects the rows of one group of cases.
class CaseReport {
public:
    /// @param quick  leave out what takes long
    CaseReport(std::string group, bool quick) : group_(std::move(group)), quick_(quick) {}

    /// The source of all rows that follow.
    void from(const std::string& source) { source_ = source; }
    /// Passes if |measured - reference| <= tolerance |reference|.
    void relative(const std::string& quantity, double reference, double measured, double tolerance);
    /// Passes if |measured - reference| <= tolerance.
    void absolute(const std::string& quantity, double reference, double measured, double tolerance);
    /// An error that was measured elsewhere; passes if error <= tolerance.
    void judge(const std::string& quantity, double reference, double measured, double error, double tolerance);
    /// A relative error without a verdict.
    void inform(const std::string& quantity, double reference, double measured);
    /// A case that ended with an exception.
    void fail(const std::string& reason);

    bool quick() const { return quick_; }
    const std::vector<ValidationRow>& rows() const { return rows_; }

private:
    std::string group_, source_;
    bool quick_;
    std::vector<ValidationRow> rows_;
};

/// The rows as a table of text.
std::string validation_table(const std::vector<ValidationRow>& rows);

/// The rows as JSON text: {"cases": [{case, quantity, reference, measured, error, tolerance, pass, source}]}.
/// A row without a verdict has the tolerance null.
std::string validation_json(const std::vector<ValidationRow>& rows);

}  // namespace selvage
