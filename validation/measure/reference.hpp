#pragma once
#include <map>
#include <span>
#include <string>
#include <vector>

#include "io/scene/presets.hpp"

namespace selvage {

/// Returns the files of validation/reference, which are built into the program. The first lines of each file give the
/// source of its numbers.
std::span<const PresetFile> reference_files();

/// A row of a reference table: its cells by the names in the table's head.
class ReferenceRow {
public:
    explicit ReferenceRow(std::map<std::string, std::string> cells) : cells_(std::move(cells)) {}
    /// @throws std::runtime_error if there is no such column
    const std::string& text(const std::string& column) const;
    /// @throws std::runtime_error if the cell does not hold a number
    double number(const std::string& column) const;

private:
    std::map<std::string, std::string> cells_;
};

/// Reads a reference table. Lines that start with # are comments; the first other line names the columns.
/// @param name  file name without folder, such as `catenary_cases.csv`
/// @throws std::runtime_error if there is no such file
std::vector<ReferenceRow> reference_table(const std::string& name);

/// Returns the value of a row of oscillation_references.csv.
/// @throws std::runtime_error if there is no such row
double oscillation_reference(const std::string& test, const std::string& key);

}  // namespace selvage
