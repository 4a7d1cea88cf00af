#pragma once
#include <string>
#include <vector>

#include "io/pattern/json_cursor.hpp"
#include "io/pattern/pattern.hpp"

namespace selvage {

/// How a pattern file writes lengths and control points.
struct PatternUnits {
    double scale = 0.01;            ///< Metres per unit of the file.
    bool relative_controls = true;  ///< Control points count along and across the edge, in edge lengths.
};

/// Reads the closed outline of a panel whose vertices are known.
/// @param warnings  gets what is odd but usable
/// @throws InputError for wrong values, an open or crossing-over loop, edges without length
void read_edges(const JsonCursor& cursor, const PatternUnits& units, PatternPanel& panel,
                std::vector<std::string>& warnings);

}  // namespace selvage
