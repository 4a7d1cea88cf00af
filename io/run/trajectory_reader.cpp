#include <stdexcept>

#include "io/errors.hpp"
#include "io/run/trajectory.hpp"
#include "io/run/trajectory_format.hpp"

namespace selvage {

using namespace trajectory_format;

namespace {

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

TrajectoryLayout read_layout(const Hdf5File& file)
{
    TrajectoryLayout layout;
    layout.point_count = int(file.read_integers("/VTKHDF/NumberOfPoints").at(0));
    layout.triangles = rows_of<Face>(file.read_integers("/selvage/triangles"));
    layout.panel_coordinates = rows_of<Vec2>(file.read_reals("/VTKHDF/PointData/panel_coordinates"));
    for (const std::int64_t panel : file.read_integers("/VTKHDF/PointData/panel")) layout.panel.push_back(int(panel));
    layout.rest_edge_lengths = rows_of<std::array<double, 3>>(file.read_reals("/VTKHDF/CellData/rest_edge_lengths"));
    layout.seam_pairs = rows_of<std::array<int, 2>>(file.read_integers("/selvage/seam_pairs"));
    layout.panel_names = file.texts("/selvage", "panel_names");
    layout.scene_text = file.text("/selvage", "scene_text");
    layout.scene_file = file.text("/selvage", "scene_file");
    layout.version = file.text("/selvage", "version");
    layout.grid = grid_with_spacing(file.real("/selvage", "position_grid"));
    return layout;
}

std::vector<FrameScalars> read_scalars(const Hdf5File& file, std::size_t frame_count)
{
    const auto time = file.read_reals("/selvage/time"), kinetic = file.read_reals("/selvage/kinetic_energy"),
               total = file.read_reals("/selvage/total_energy"), residual = file.read_reals("/selvage/residual"),
               wall = file.read_reals("/selvage/wall_seconds");
    const auto contacts = file.read_integers("/selvage/contacts"),
               iterations = file.read_integers("/selvage/iterations");
    std::vector<FrameScalars> scalars(frame_count);
    for (std::size_t frame = 0; frame < frame_count; ++frame)
        scalars[frame] = {time.at(frame), kinetic.at(frame),       total.at(frame),          residual.at(frame),
                          wall.at(frame), int(contacts.at(frame)), int(iterations.at(frame))};
    return scalars;
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
    try {
        layout_ = read_layout(*file_);
        scalars_ = read_scalars(*file_, std::size_t(file_->integer(steps, "NSteps")));
        if (file_->shape(points).at(0) < hsize_t(layout_.point_count) * scalars_.size())
            throw std::runtime_error("fewer positions than frames");
    } catch (const InputError&) {
        throw;
    } catch (const std::exception& fault) {
        throw not_a_run(path, fault.what());
    }
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
    require_hdf5(H5Dread(dataset, H5T_NATIVE_DOUBLE, target, source, H5P_DEFAULT, values.data()), file_->path());
    return rows_of<Vec3>(values);
}

std::vector<unsigned char> TrajectoryReader::read_raw_frame(int frame, std::uint32_t& filter_mask) const
{
    check_frame(frame);
    const std::array<hsize_t, 2> start{hsize_t(frame) * hsize_t(layout_.point_count), 0};
    const Hdf5Id dataset = open_points(*file_);
    hsize_t size = 0;
    require_hdf5(H5Dget_chunk_storage_size(dataset, start.data(), &size), file_->path());
    std::vector<unsigned char> bytes(size);
#if H5_VERSION_GE(2, 0, 0)  // the name has gone to a function that is told the size
    std::size_t room = bytes.size();
    const herr_t status = H5Dread_chunk2(dataset, H5P_DEFAULT, start.data(), &filter_mask, bytes.data(), &room);
#else
    const herr_t status = H5Dread_chunk(dataset, H5P_DEFAULT, start.data(), &filter_mask, bytes.data());
#endif
    require_hdf5(status, file_->path());
    return bytes;
}

}  // namespace selvage
