#include "io/run/trajectory_format.hpp"

#include <algorithm>
#include <limits>
#include <stdexcept>

namespace selvage::trajectory_format {
namespace {

constexpr hsize_t column_chunk = 256;  // rows; 2 KiB of a scalar, so that the files of short runs stay small

void check(const TrajectoryLayout& layout)
{
    const auto point_count = std::size_t(layout.point_count);
    const auto is_point = [&](int index) { return index >= 0 && index < layout.point_count; };
    if (layout.point_count < 1) throw std::invalid_argument("trajectory: no points");
    if (layout.panel_coordinates.size() != point_count || layout.panel.size() != point_count)
        throw std::invalid_argument("trajectory: point arrays differ in length from the points");
    if (layout.rest_edge_lengths.size() != layout.triangles.size())
        throw std::invalid_argument("trajectory: rest_edge_lengths differ in length from the triangles");
    if (layout.rest_corners.size() != layout.triangle_panel.size() ||
        (!layout.rest_corners.empty() && layout.rest_corners.size() != layout.triangles.size()))
        throw std::invalid_argument("trajectory: rest_corners or panels differ in length from the triangles");
    for (const Face& face : layout.triangles)
        if (!std::ranges::all_of(face, is_point)) throw std::invalid_argument("trajectory: triangle without its point");
    for (const auto& pair : layout.seam_pairs)
        if (!std::ranges::all_of(pair, is_point))
            throw std::invalid_argument("trajectory: seam pair without its point");
}

template <class Rows>
std::vector<std::int64_t> flatten_integers(const Rows& rows)
{
    std::vector<std::int64_t> values;
    for (const auto& row : rows) values.insert(values.end(), row.begin(), row.end());
    return values;
}

// Writes one of VTK's four kinds of cells. VTK requires that every kind is present, even if it is empty.
void write_cells(Hdf5File& file, const std::string& group, const std::vector<Face>& faces)
{
    const std::vector<std::int64_t> connectivity = flatten_integers(faces);
    std::vector<std::int64_t> offsets(faces.size() + 1);
    for (std::size_t face = 0; face < offsets.size(); ++face) offsets[face] = 3 * std::int64_t(face);
    const Hdf5Storage storage{.compressed = !faces.empty(), .growing = false, .chunk = {}};
    const std::array<std::int64_t, 1> cell_count{std::int64_t(faces.size())}, id_count{3 * cell_count[0]};
    file.make_group(group);
    file.write(group + "/NumberOfCells", H5T_STD_I64LE, {1}, cell_count);
    file.write(group + "/NumberOfConnectivityIds", H5T_STD_I64LE, {1}, id_count);
    file.write(group + "/Offsets", H5T_STD_I64LE, {offsets.size()}, offsets, storage);
    file.write(group + "/Connectivity", H5T_STD_I64LE, {connectivity.size()}, connectivity, storage);
}

// A virtual dataset that shows all numbers of another one in another shape.
void write_view(Hdf5File& file, const char* name, const std::vector<hsize_t>& shape, const char* source,
                const std::vector<hsize_t>& source_shape)
{
    const Hdf5Id space(H5Screate_simple(int(shape.size()), shape.data(), nullptr), H5Sclose, name);
    const Hdf5Id source_space(H5Screate_simple(int(source_shape.size()), source_shape.data(), nullptr), H5Sclose, name);
    const Hdf5Id properties(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, name);
    require_hdf5(H5Pset_virtual(properties, space, ".", source, source_space), name);
    Hdf5Id(H5Dcreate2(file.id(), name, H5T_IEEE_F32LE, space, H5P_DEFAULT, properties, H5P_DEFAULT), H5Dclose, name);
}

// VTK reads arrays of two dimensions only; everyone else gets the corners in three.
void write_rest_corners(Hdf5File& file, const TrajectoryLayout& layout, const Hdf5Storage& storage)
{
    if (layout.rest_corners.empty()) return;
    std::vector<double> corners;
    for (const auto& triangle : layout.rest_corners)
        for (const Vec2& corner : triangle) corners.insert(corners.end(), {corner.x(), corner.y()});
    const std::vector<std::int64_t> panel(layout.triangle_panel.begin(), layout.triangle_panel.end());
    const hsize_t count = panel.size();
    file.write(rest_corners, H5T_IEEE_F32LE, {count, 6}, corners, storage);
    file.write(triangle_panel, H5T_STD_I32LE, {count}, panel, storage);
    write_view(file, "/selvage/rest_corners", {count, 3, 2}, rest_corners, {count, 6});
}

void write_arrays(Hdf5File& file, const TrajectoryLayout& layout)
{
    const Hdf5Storage compressed{.compressed = true, .growing = false, .chunk = {}};
    std::vector<double> coordinates, lengths;
    for (const Vec2& x : layout.panel_coordinates) coordinates.insert(coordinates.end(), {x.x(), x.y()});
    for (const auto& row : layout.rest_edge_lengths) lengths.insert(lengths.end(), row.begin(), row.end());
    const std::vector<std::int64_t> panel(layout.panel.begin(), layout.panel.end());
    const hsize_t point_count = panel.size(), triangle_count = layout.triangles.size();
    file.make_group("/VTKHDF/PointData");
    file.make_group("/VTKHDF/CellData");
    file.write("/VTKHDF/PointData/panel_coordinates", H5T_IEEE_F32LE, {point_count, 2}, coordinates, compressed);
    file.write("/VTKHDF/PointData/panel", H5T_STD_I32LE, {point_count}, panel, compressed);
    file.write("/VTKHDF/CellData/rest_edge_lengths", H5T_IEEE_F32LE, {triangle_count, 3}, lengths, compressed);
    write_rest_corners(file, layout, compressed);
    file.write("/selvage/triangles", H5T_STD_I32LE, {triangle_count, 3}, flatten_integers(layout.triangles),
               compressed);
    file.write("/selvage/seam_pairs", H5T_STD_I32LE, {layout.seam_pairs.size(), 2}, flatten_integers(layout.seam_pairs),
               compressed);
}

void write_attributes(Hdf5File& file, const TrajectoryLayout& layout)
{
    const std::array<std::int64_t, 2> vtkhdf_version{2, 0};
    file.set_integers("/VTKHDF", "Version", vtkhdf_version);
    file.set_fixed_text("/VTKHDF", "Type", "PolyData");
    file.set_text("/selvage", "schema", schema);
    file.set_text("/selvage", "version", layout.version);
    file.set_text("/selvage", "scene_text", layout.scene_text);
    file.set_text("/selvage", "scene_file", layout.scene_file);
    file.set_text("/selvage", "length_unit", "m");
    file.set_text("/selvage", "up_axis", "z");
    file.set_real("/selvage", "position_grid", grid_spacing(layout.grid));
    if (!layout.panel_names.empty()) file.set_texts("/selvage", "panel_names", layout.panel_names);
}

void make_column(Hdf5File& file, const FrameColumn& column)
{
    std::vector<hsize_t> shape{0}, chunk{column_chunk};
    if (column.width > 1) shape.push_back(hsize_t(column.width)), chunk.push_back(hsize_t(column.width));
    file.make_dataset(column.name, column.integer ? H5T_STD_I64LE : H5T_IEEE_F64LE, shape,
                      {.compressed = false, .growing = true, .chunk = chunk});
}

void write_columns(Hdf5File& file)
{
    file.make_group(steps);
    file.make_group("/VTKHDF/Steps/PointDataOffsets");
    file.make_group("/VTKHDF/Steps/CellDataOffsets");
    for (const FrameColumn& column : frame_columns) make_column(file, column);
    for (const auto& [column, name] : column_links) file.link(column, name);
}

void write_contents(const std::string& path, const TrajectoryLayout& layout)
{
    Hdf5File file(path, Hdf5Access::create);
    const std::array<std::int64_t, 1> point_count{layout.point_count};
    file.make_group("/VTKHDF");
    file.make_group("/selvage");
    write_attributes(file, layout);
    file.make_dataset(points, H5T_IEEE_F32LE, {0, 3},
                      {.compressed = true, .growing = true, .chunk = {hsize_t(layout.point_count), 3}});
    file.write("/VTKHDF/NumberOfPoints", H5T_STD_I64LE, {1}, point_count);
    for (const char* group : {"/VTKHDF/Vertices", "/VTKHDF/Lines", "/VTKHDF/Strips"}) write_cells(file, group, {});
    write_cells(file, "/VTKHDF/Polygons", layout.triangles);
    write_arrays(file, layout);
    write_columns(file);
    // The view is made at the end of a run, in a separate group, so that a kill meanwhile cannot damage other groups.
    file.make_group("/selvage/views");
    file.link_softly("/selvage/views/positions", "/selvage/positions");
    file.close();
}

}  // namespace

void write_header(const std::string& path, const TrajectoryLayout& layout)
{
    check(layout);
    write_contents(path, layout);
    // The file is reopened so that the attribute is placed at its end: the commit driver then writes the attribute
    // after every other header.
    Hdf5File file(path, Hdf5Access::append);
    file.set_integer(steps, "NSteps", 0);
    file.close();
}

Hdf5Id open_points(const Hdf5File& file)
{
    const Hdf5Id access(H5Pcreate(H5P_DATASET_ACCESS), H5Pclose, points);
    require_hdf5(H5Pset_chunk_cache(access, 0, 0, 1), points);
    return {H5Dopen2(file.id(), points, access), H5Dclose, points};
}

void write_row(hid_t dataset, const FrameColumn& column, int frame, const std::array<double, 4>& values)
{
    const int rank = column.width > 1 ? 2 : 1;
    const std::array<hsize_t, 2> shape{hsize_t(frame) + 1, hsize_t(column.width)}, start{hsize_t(frame), 0},
        count{1, hsize_t(column.width)};
    require_hdf5(H5Dset_extent(dataset, shape.data()), column.name);
    const Hdf5Id target(H5Dget_space(dataset), H5Sclose, column.name);
    require_hdf5(H5Sselect_hyperslab(target, H5S_SELECT_SET, start.data(), nullptr, count.data(), nullptr),
                 column.name);
    const Hdf5Id source(H5Screate_simple(rank, count.data(), nullptr), H5Sclose, column.name);
    std::array<std::int64_t, 4> whole{};
    for (std::size_t k = 0; column.integer && k < 4; ++k) whole[k] = std::int64_t(values[k]);
    const void* row = column.integer ? static_cast<const void*>(whole.data()) : values.data();
    const hid_t type = column.integer ? H5T_NATIVE_INT64 : H5T_NATIVE_DOUBLE;
    require_hdf5(H5Dwrite(dataset, type, source, target, H5P_DEFAULT, row), column.name);
}

std::array<std::array<double, 4>, frame_columns.size()> frame_rows(int frame, int point_count,
                                                                   const FrameScalars& scalars)
{
    return {{{scalars.time},
             {0},
             {1},
             {double(frame) * point_count},
             {0, 0, 0, 0},
             {scalars.kinetic_energy},
             {scalars.total_energy},
             {scalars.residual},
             {scalars.wall_seconds},
             {double(scalars.contacts)},
             {double(scalars.iterations)}}};
}

void write_positions_view(Hdf5File& file, int frame_count, int point_count)
{
    if (frame_count == 0) return;
    const hsize_t frames = hsize_t(frame_count), rows = hsize_t(point_count);
    write_view(file, "/selvage/views/positions", {frames, rows, 3}, points, {frames * rows, 3});
}

}  // namespace selvage::trajectory_format
