#pragma once
#include <array>
#include <cstdint>
#include <string>

#include "io/run/hdf5_file.hpp"
#include "io/run/trajectory.hpp"

namespace selvage::trajectory_format {

inline constexpr const char* points = "/VTKHDF/Points";
inline constexpr const char* rest_corners = "/VTKHDF/CellData/rest_corners";
inline constexpr const char* triangle_panel = "/VTKHDF/CellData/panel";
inline constexpr const char* steps = "/VTKHDF/Steps";
inline constexpr const char* schema = "selvage-run-1";

/// A dataset with one row per frame.
struct FrameColumn {
    const char* name;
    bool integer;  ///< int64 if true, float64 if not.
    int width;     ///< Numbers per row; 1: the dataset has one dimension.
};

/// All columns. The first one, the time, is written together with NSteps, because vtkHDFReader overruns its buffer when
/// a file has more times than steps.
inline constexpr std::array<FrameColumn, 11> frame_columns{{
    {"/selvage/time", false, 1},
    {"/VTKHDF/Steps/PartOffsets", true, 1},
    {"/VTKHDF/Steps/NumberOfParts", true, 1},
    {"/VTKHDF/Steps/PointOffsets", true, 1},
    {"/VTKHDF/Steps/CellOffsets", true, 4},
    {"/selvage/kinetic_energy", false, 1},
    {"/selvage/total_energy", false, 1},
    {"/selvage/residual", false, 1},
    {"/selvage/wall_seconds", false, 1},
    {"/selvage/contacts", true, 1},
    {"/selvage/iterations", true, 1},
}};

/// Datasets that VTK requires and that are equal to a frame column: each is a hard link, {column, link}.
inline constexpr std::array<std::array<const char*, 2>, 7> column_links{{
    {"/VTKHDF/Steps/CellOffsets", "/VTKHDF/Steps/ConnectivityIdOffsets"},
    {"/VTKHDF/Steps/PartOffsets", "/VTKHDF/Steps/PointDataOffsets/panel_coordinates"},
    {"/VTKHDF/Steps/PartOffsets", "/VTKHDF/Steps/PointDataOffsets/panel"},
    {"/VTKHDF/Steps/PartOffsets", "/VTKHDF/Steps/CellDataOffsets/rest_edge_lengths"},
    {"/VTKHDF/Steps/PartOffsets", "/VTKHDF/Steps/CellDataOffsets/rest_corners"},
    {"/VTKHDF/Steps/PartOffsets", "/VTKHDF/Steps/CellDataOffsets/panel"},
    {"/selvage/time", "/VTKHDF/Steps/Values"},
}};

/// Writes a complete file without frames under `path`.
void write_header(const std::string& path, const TrajectoryLayout& layout);

/// Opens the dataset of positions for writing. It has no chunk cache, because each chunk is written once.
Hdf5Id open_points(const Hdf5File& file);

/// Extends a column to `frame` + 1 rows and writes the last one.
/// @param values  the row, up to four numbers; integer columns truncate them
void write_row(hid_t dataset, const FrameColumn& column, int frame, const std::array<double, 4>& values);

/// Returns the row of every column for one frame.
std::array<std::array<double, 4>, frame_columns.size()> frame_rows(int frame, int point_count,
                                                                   const FrameScalars& scalars);

/// Makes the virtual dataset of shape (frames, points, 3) to which the soft link `/selvage/positions` points.
void write_positions_view(Hdf5File& file, int frame_count, int point_count);

}  // namespace selvage::trajectory_format
