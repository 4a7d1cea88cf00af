#pragma once
#include <string>
#include <vector>

#include "bench/harness/child_run.hpp"

namespace selvage {

/// A pattern and the body that it is to dress.
struct GarmentRow {
    std::string pattern, body;  ///< Files.
    std::string name() const;   ///< `PATTERN@BODY`, without folders and endings.
};

/// How the rows of a table are dressed.
struct GarmentOptions {
    std::string resolution = "0.015";      ///< Target edge length [m].
    std::string limit = "180";             ///< Wall time after which a run stops [s].
    std::string up_axis = "y";             ///< Of the bodies.
    std::string folder;                    ///< Each run's output stays in a folder of its own in it.
    std::vector<std::string> assignments;  ///< Further keys of the scene, as `key=value`.
};

/// What has become of a row.
struct DressedRow {
    GarmentRow row;
    std::string status;  ///< Of the summary, or `exit CODE` without one.
    double wall_s = 0;   ///< Of the whole process.
    int vertices = 0;
    int self = 0, body = 0;  ///< Pairs of triangles that intersect at the end; -1: not counted.
    double penetration = 0;  ///< Depth of the deepest vertex in a body [m].
    double gap = 0;          ///< Largest of the stitched pairs [m].
    double stretch = 0;      ///< 99th percentile of the larger principal stretch, above 1 [1].
    bool good = false;       ///< Converged, joined, and nothing intersects.
    std::string message;     ///< Last line that a run printed which is not good.
    std::string picture;     ///< File; empty: there is none.
};

/// Reads a manifest: a pattern and a body a line, separated by a tab; `#` begins a comment. Names are relative to the
/// folder of the file, or else to the one above it.
/// @throws InputError for a line without two names, and for files that do not exist, with the line
std::vector<GarmentRow> read_manifest(const std::string& file);

/// Every pattern (*.json) of a folder on every one of these bodies, in the order of their names.
/// @throws InputError if there is no pattern
std::vector<GarmentRow> rows_of_folder(const std::string& folder, const std::vector<std::string>& bodies);

/// Dresses a row in a process of its own.
DressedRow dress(const GarmentRow& row, const GarmentOptions& options);

}  // namespace selvage
