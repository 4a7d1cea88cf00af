#include "validation/measure/reference.hpp"

#include <sstream>
#include <stdexcept>

namespace selvage {
namespace {

// Cells are separated by commas; a cell in double quotes may hold commas.
std::vector<std::string> split(const std::string& line)
{
    std::vector<std::string> cells(1);
    bool quoted = false;
    for (const char c : line) {
        if (c == '"')
            quoted = !quoted;
        else if (c == ',' && !quoted)
            cells.emplace_back();
        else
            cells.back() += c;
    }
    return cells;
}

}  // namespace

const std::string& ReferenceRow::text(const std::string& column) const
{
    const auto cell = cells_.find(column);
    if (cell == cells_.end()) throw std::runtime_error("reference table without a column " + column);
    return cell->second;
}

double ReferenceRow::number(const std::string& column) const
{
    const std::string& cell = text(column);
    std::size_t end = 0;
    const double value = cell.empty() ? 0 : std::stod(cell, &end);
    if (end == 0) throw std::runtime_error("no number in column " + column + ": " + cell);
    return value;
}

std::vector<ReferenceRow> reference_table(const std::string& name)
{
    for (const PresetFile& file : reference_files()) {
        if (file.path != name) continue;
        std::istringstream stream{std::string(file.text)};
        std::vector<std::string> head;
        std::vector<ReferenceRow> rows;
        for (std::string line; std::getline(stream, line);) {
            if (line.empty() || line[0] == '#') continue;
            const std::vector<std::string> cells = split(line);
            if (head.empty()) {
                head = cells;
                continue;
            }
            std::map<std::string, std::string> named;
            for (std::size_t i = 0; i < head.size() && i < cells.size(); ++i) named[head[i]] = cells[i];
            rows.emplace_back(std::move(named));
        }
        return rows;
    }
    throw std::runtime_error("no reference file " + name);
}

double oscillation_reference(const std::string& test, const std::string& key)
{
    for (const ReferenceRow& row : reference_table("oscillation_references.csv"))
        if (row.text("test") == test && row.text("key") == key) return row.number("value");
    throw std::runtime_error("oscillation_references.csv has no row " + test + ", " + key);
}

}  // namespace selvage
