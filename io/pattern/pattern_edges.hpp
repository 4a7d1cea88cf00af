#pragma once
#include <string>
#include <vector>

#include "io/pattern/json_cursor.hpp"
#include "io/pattern/pattern.hpp"

namespace selvage {

/// The units in which a pattern file gives lengths and control points.
struct PatternUnits {
    double scale = 0.01;            ///< Metres per unit of the file.
    bool relative_controls = true;  ///< Control points are along and across the edge, in units of its length.
};

/// Reads the closed outline of a panel whose vertices are known.
/// @param panel     its vertices are read, its edges are filled
/// @param findings  unusual but usable values are added to it
/// @throws InputError for wrong values, an open or self-crossing loop, edges without length
void read_edges(const JsonCursor& cursor, const PatternUnits& units, PatternPanel& panel,
                std::vector<Finding>& findings);

}  // namespace selvage
