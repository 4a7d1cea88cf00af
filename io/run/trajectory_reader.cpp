#include <algorithm>
#include <climits>
#include <cmath>

#include "io/errors.hpp"
#include "io/run/hdf5_filters.hpp"
#include "io/run/hdf5_reader.hpp"
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

int read_point_count(const Hdf5Reader& file)
{
    constexpr const char* name = "/VTKHDF/NumberOfPoints";
    const std::int64_t count = file.read_integers(name, {1}).front();
    // Each point has at least its panel in the file.
    if (count < 1 || std::uint64_t(count) > std::min(Hdf5Reader::most_expansion * file.size(), std::uint64_t(INT_MAX)))
        file.refuse(name, std::to_string(count), "a number of points that the file can hold");
    return int(count);
}

int read_frame_count(const Hdf5Reader& file)
{
    const std::int64_t count = file.integer(steps, "NSteps");
    if (count < 0 || std::uint64_t(count) > file.size())
        file.refuse(std::string(steps) + "@NSteps", std::to_string(count), "a number of frames that the file can hold");
    return int(count);
}

TrajectoryLayout read_layout(const Hdf5Reader& file)
{
    constexpr std::uint64_t any = Hdf5Reader::any;
    TrajectoryLayout layout;
    layout.point_count = read_point_count(file);
    const auto points = std::uint64_t(layout.point_count);
    layout.triangles = rows_of<Face>(file.read_indices("/selvage/triangles", {any, 3}, layout.point_count, "point"));
    const std::uint64_t triangles = layout.triangles.size();
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

std::vector<FrameScalars> read_scalars(const Hdf5Reader& file)
{
    const auto frame_count = std::uint64_t(read_frame_count(file));
    const auto column = [&](const char* name) { return file.read_reals(name, {Hdf5Reader::any}, frame_count); };
    const auto whole = [&](const char* name) { return file.read_integers(name, {Hdf5Reader::any}, frame_count); };
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
void require_frames(const Hdf5Reader& file, const Hdf5Reader::Dataset& frames, std::size_t point_count,
                    std::size_t frame_count)
{
    const Hdf5Reader::Shape& shape = frames.shape;
    if (shape.size() != 2 || shape[1] != 3 || shape[0] / point_count < frame_count)
        file.refuse(
            points, shape.empty() ? "a single number" : std::to_string(shape[0]) + " rows",
            std::to_string(frame_count) + " frames of " + std::to_string(point_count) + " points with 3 numbers");
    if (frames.chunk_rows != point_count || !frames.number.real || frames.number.bytes != sizeof(float) ||
        frames.filters != std::vector<int>{shuffle_filter, deflate_filter})
        file.refuse(points, "another storage", "a chunk of compressed numbers for each frame");
    for (std::size_t frame = 0; frame < frame_count; ++frame)
        if (const auto* chunk = Hdf5Reader::chunk_of(frames, frame * point_count);
            !chunk || chunk->skipped_filters != 0)
            file.refuse(points, "no data of frame " + std::to_string(frame), "a chunk of positions");
}

InputError not_a_run(const std::string& path, const std::string& found)
{
    return InputError({path, 0, 0, {}}, found, "a run written by selvage (run.h5)");
}

}  // namespace

struct TrajectoryReader::Frames : Hdf5Reader::Dataset {};

TrajectoryReader::TrajectoryReader(TrajectoryReader&&) noexcept = default;
TrajectoryReader::~TrajectoryReader() = default;

TrajectoryReader::TrajectoryReader(const std::string& path) : file_(std::make_unique<Hdf5Reader>(path))
{
    if (!file_->exists("/selvage/triangles") || !file_->exists(points))
        throw not_a_run(path, "an HDF5 file without /selvage/triangles and /VTKHDF/Points");
    layout_ = read_layout(*file_);
    scalars_ = read_scalars(*file_);
    frames_ = std::make_unique<Frames>(Frames{file_->open(points, !scalars_.empty())});
    require_frames(*file_, *frames_, std::size_t(layout_.point_count), scalars_.size());
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
    const auto count = std::uint64_t(layout_.point_count);
    const std::vector<double> values = file_->read_reals(*frames_, std::uint64_t(frame) * count, count, false);
    if (!std::ranges::all_of(values, [](double x) { return std::abs(x) <= largest_position; }))
        file_->refuse(points, "a position of frame " + std::to_string(frame) + " that is not finite or beyond 1e9 m",
                      "positions in metres");
    return rows_of<Vec3>(values);
}

std::vector<unsigned char> TrajectoryReader::read_raw_frame(int frame) const
{
    check_frame(frame);
    const std::uint64_t row = std::uint64_t(frame) * std::uint64_t(layout_.point_count);
    return file_->stored_bytes(*frames_, *Hdf5Reader::chunk_of(*frames_, row));
}

}  // namespace selvage
