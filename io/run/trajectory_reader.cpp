#include <algorithm>
#include <climits>
#include <cmath>

#include "io/errors.hpp"
#include "io/run/hdf5_checks.hpp"
#include "io/run/trajectory.hpp"
#include "io/run/trajectory_format.hpp"

namespace selvage {

using namespace trajectory_format;

namespace {

constexpr double largest_position = 1e9;  // [m], as in OBJ files

PositionGrid grid_with_spacing(double spacing)
{
    for (const PositionGrid grid : {PositionGrid::fine_8um, PositionGrid::coarse_60um})
        if (spacing == grid_spacing(grid)) return grid;
    return PositionGrid::lossless;
}

template <class Row, class Value>
std::vector<Row> rows_of(const std::vector<Value>& values)
{
    Row row{};
    std::vector<Row> rows(values.size() / std::size_t(row.size()));
    for (std::size_t index = 0; index < values.size(); ++index)
        rows[index / rows[0].size()][index % rows[0].size()] =
            static_cast<std::decay_t<decltype(row[0])>>(values[index]);
    return rows;
}

std::vector<std::array<Vec2, 3>> corners_of(const std::vector<double>& values)
{
    std::vector<std::array<Vec2, 3>> corners;
    for (std::size_t k = 0; k < values.size(); k += 6)
        corners.push_back(
            {Vec2(values[k], values[k + 1]), Vec2(values[k + 2], values[k + 3]), Vec2(values[k + 4], values[k + 5])});
    return corners;
}

int read_point_count(const Hdf5File& file)
{
    constexpr const char* name = "/VTKHDF/NumberOfPoints";
    const std::int64_t count = file.read_integers(name, {1}).front();
    // Each point has at least its panel in the file.
    if (count < 1 || std::uintmax_t(count) > std::min(most_file_expansion * file.size(), std::uintmax_t(INT_MAX)))
        file.refuse(name, std::to_string(count), "a number of points that the file can hold");
    return int(count);
}

int read_frame_count(const Hdf5File& file)
{
    const std::int64_t count = file.integer(steps, "NSteps");
    if (count < 0 || std::uintmax_t(count) > file.size())
        file.refuse(std::string(steps) + "@NSteps", std::to_string(count), "a number of frames that the file can hold");
    return int(count);
}

TrajectoryLayout read_layout(const Hdf5File& file)
{
    constexpr hsize_t any = Hdf5File::any;
    TrajectoryLayout layout;
    layout.point_count = read_point_count(file);
    const auto points = hsize_t(layout.point_count);
    layout.triangles = rows_of<Face>(file.read_indices("/selvage/triangles", {any, 3}, layout.point_count, "point"));
    const hsize_t triangles = layout.triangles.size();
    layout.panel_names = file.texts("/selvage", "panel_names");
    const std::int64_t panels = layout.panel_names.empty() ? INT_MAX : std::int64_t(layout.panel_names.size());
    layout.panel_coordinates = rows_of<Vec2>(file.read_reals("/VTKHDF/PointData/panel_coordinates", {points, 2}));
    layout.panel = file.read_indices("/VTKHDF/PointData/panel", {points}, panels, "panel");
    layout.rest_edge_lengths =
        rows_of<std::array<double, 3>>(file.read_reals("/VTKHDF/CellData/rest_edge_lengths", {triangles, 3}));
    if (file.exists(rest_corners)) {
        layout.rest_corners = corners_of(file.read_reals(rest_corners, {triangles, 6}));
        layout.triangle_panel = file.read_indices(triangle_panel, {triangles}, panels, "panel");
    }
    layout.seam_pairs =
        rows_of<std::array<int, 2>>(file.read_indices("/selvage/seam_pairs", {any, 2}, layout.point_count, "point"));
    layout.scene_text = file.text("/selvage", "scene_text");
    layout.scene_file = file.text("/selvage", "scene_file");
    layout.version = file.text("/selvage", "version");
    layout.grid = grid_with_spacing(file.real("/selvage", "position_grid"));
    return layout;
}

std::vector<FrameScalars> read_scalars(const Hdf5File& file)
{
    const auto frame_count = hsize_t(read_frame_count(file));
    const auto column = [&](const char* name) { return file.read_reals(name, {Hdf5File::any}, frame_count); };
    const auto whole = [&](const char* name) { return file.read_integers(name, {Hdf5File::any}, frame_count); };
    const auto time = column("/selvage/time"), kinetic = column("/selvage/kinetic_energy"),
               total = column("/selvage/total_energy"), residual = column("/selvage/residual"),
               wall = column("/selvage/wall_seconds");
    const auto contacts = whole("/selvage/contacts"), iterations = whole("/selvage/iterations");
    std::vector<FrameScalars> scalars(frame_count);
    for (std::size_t frame = 0; frame < frame_count; ++frame) {
        if (!std::isfinite(time[frame]) || (frame > 0 && !(time[frame] > time[frame - 1])))
            file.refuse("/selvage/time[" + std::to_string(frame) + "]", std::to_string(time[frame]),
                        "a later time than that of the frame before, in seconds");
        scalars[frame] = {time[frame], kinetic[frame],       total[frame],          residual[frame],
                          wall[frame], int(contacts[frame]), int(iterations[frame])};
    }
    return scalars;
}

// Frames are read, and copied on resuming, as whole chunks.
void require_frames(const Hdf5File& file, int point_count, std::size_t frame_count)
{
    const std::vector<hsize_t> shape = file.shape(points), chunk{hsize_t(point_count), 3};
    if (shape.size() != 2 || shape[1] != 3 || shape[0] / chunk[0] < frame_count)
        file.refuse(
            points, shape.empty() ? "a single number" : std::to_string(shape[0]) + " rows",
            std::to_string(frame_count) + " frames of " + std::to_string(point_count) + " points with 3 numbers");
    const Hdf5Id dataset = open_points(file);
    const Hdf5Id properties(H5Dget_create_plist(dataset), H5Pclose, points);
    std::array<hsize_t, 2> found{};
    if (H5Pget_layout(properties) != H5D_CHUNKED || H5Pget_chunk(properties, 2, found.data()) != 2 ||
        !std::ranges::equal(found, chunk))
        file.refuse(points, "another storage", "one chunk for each frame");
    const std::uintmax_t bytes = saturated_product(frame_count, 3 * sizeof(float) * chunk[0]);
    if (const Hdf5Fault fault = check_dataset(dataset, bytes, file.size(), UINTMAX_MAX))
        file.refuse(points, fault.found, fault.expected);
}

InputError not_a_run(const std::string& path, const std::string& found)
{
    return InputError({path, 0, 0, {}}, found, "a run written by selvage (run.h5)");
}

}  // namespace

TrajectoryReader::TrajectoryReader(TrajectoryReader&&) noexcept = default;
TrajectoryReader::~TrajectoryReader() = default;

TrajectoryReader::TrajectoryReader(const std::string& path) : file_(std::make_unique<Hdf5File>(path, Hdf5Access::read))
{
    if (!file_->exists("/selvage/triangles") || !file_->exists(points))
        throw not_a_run(path, "an HDF5 file without /selvage/triangles and /VTKHDF/Points");
    layout_ = read_layout(*file_);
    scalars_ = read_scalars(*file_);
    require_frames(*file_, layout_.point_count, scalars_.size());
}

void TrajectoryReader::check_frame(int frame) const
{
    if (frame < 0 || frame >= frame_count())
        throw InputError({file_->path(), 0, 0, "frame"}, std::to_string(frame),
                         "a frame from 0 to " + std::to_string(frame_count() - 1));
}

std::vector<Vec3> TrajectoryReader::read_frame(int frame) const
{
    check_frame(frame);
    const std::array<hsize_t, 2> start{hsize_t(frame) * hsize_t(layout_.point_count), 0},
        count{hsize_t(layout_.point_count), 3};
    const Hdf5Id dataset = open_points(*file_);
    const Hdf5Id source(H5Dget_space(dataset), H5Sclose, points);
    require_hdf5(H5Sselect_hyperslab(source, H5S_SELECT_SET, start.data(), nullptr, count.data(), nullptr), points);
    const Hdf5Id target(H5Screate_simple(2, count.data(), nullptr), H5Sclose, points);
    std::vector<double> values(3 * std::size_t(layout_.point_count));
    if (H5Dread(dataset, H5T_NATIVE_DOUBLE, target, source, H5P_DEFAULT, values.data()) < 0)
        file_->refuse(points, "damaged data of frame " + std::to_string(frame), "positions");
    if (!std::ranges::all_of(values, [](double x) { return std::abs(x) <= largest_position; }))
        file_->refuse(points, "a position of frame " + std::to_string(frame) + " that is not finite or beyond 1e9 m",
                      "positions in metres");
    return rows_of<Vec3>(values);
}

std::vector<unsigned char> TrajectoryReader::read_raw_frame(int frame, std::uint32_t& filter_mask) const
{
    check_frame(frame);
    const std::array<hsize_t, 2> start{hsize_t(frame) * hsize_t(layout_.point_count), 0};
    const Hdf5Id dataset = open_points(*file_);
    hsize_t size = 0;
    if (H5Dget_chunk_storage_size(dataset, start.data(), &size) < 0 || size > file_->size())
        file_->refuse(points, "damaged data of frame " + std::to_string(frame), "a chunk of positions");
    std::vector<unsigned char> bytes(size);
#if H5_VERSION_GE(2, 0, 0)  // the name has gone to a function that is told the size
    std::size_t room = bytes.size();
    const herr_t status = H5Dread_chunk2(dataset, H5P_DEFAULT, start.data(), &filter_mask, bytes.data(), &room);
#else
    const herr_t status = H5Dread_chunk(dataset, H5P_DEFAULT, start.data(), &filter_mask, bytes.data());
#endif
    if (status < 0) file_->refuse(points, "damaged data of frame " + std::to_string(frame), "a chunk of positions");
    return bytes;
}

}  // namespace selvage
