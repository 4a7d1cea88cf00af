#include <cerrno>
#include <cmath>
#include <filesystem>
#include <stdexcept>

#include "io/atomic_file.hpp"
#include "io/errors.hpp"
#include "io/run/trajectory.hpp"
#include "io/run/trajectory_format.hpp"
#include "io/run/xdmf.hpp"

namespace selvage {

using namespace trajectory_format;

namespace {

constexpr std::chrono::seconds index_interval{2};  // between rewrites of run.xdmf; chosen by hand, not measured

std::string index_path(const std::string& path)
{
    return std::filesystem::path(path).replace_extension(".xdmf").string();
}

// Writes the header under a temporary name first, so that readers never see a file with an incomplete header.
void put_header(const std::string& path, const TrajectoryLayout& layout)
{
    TemporaryFile temporary(path);
    write_header(temporary.name(), layout);
    temporary.move_into_place();
}

// Gives a file a second name, which takes the place of one that another file had.
bool put_second_name(const std::string& path)
{
    const std::string name = std::filesystem::path(path).replace_extension(".vtkhdf").string();
    const std::string temporary = temporary_name(name);
    std::error_code error;
    std::filesystem::remove(temporary, error);
    std::filesystem::create_hard_link(path, temporary, error);
    if (error) {
        std::filesystem::remove(name, error);
        return false;
    }
    std::filesystem::rename(temporary, name, error);
    std::error_code gone;
    std::filesystem::remove(temporary, gone);  // renaming to a name of the same file does nothing
    return !error;
}

void lengthen_points(hid_t points_dataset, int frame_count, int point_count)
{
    const std::array<hsize_t, 2> shape{hsize_t(frame_count) * hsize_t(point_count), 3};
    require_hdf5(H5Dset_extent(points_dataset, shape.data()), points);
}

// Copies the first frames of an old file to a new one without decompressing them.
void copy_frames(const TrajectoryReader& old, const std::string& path, int frame_count)
{
    Hdf5File file(path, Hdf5Access::append);
    const int point_count = old.layout().point_count;
    const Hdf5Id target = open_points(file);
    lengthen_points(target, frame_count, point_count);
    for (int frame = 0; frame < frame_count; ++frame) {
        const std::vector<unsigned char> raw = old.read_raw_frame(frame);
        const std::array<hsize_t, 2> start{hsize_t(frame) * hsize_t(point_count), 0};
        require_hdf5(H5Dwrite_chunk(target, H5P_DEFAULT, 0, start.data(), raw.size(), raw.data()), points);
    }
    for (std::size_t column = 0; column < frame_columns.size(); ++column) {
        const Hdf5Id dataset = file.open_dataset(frame_columns[column].name);
        for (int frame = 0; frame < frame_count; ++frame)
            write_row(dataset, frame_columns[column], frame,
                      frame_rows(frame, point_count, old.scalars(frame))[column]);
    }
    file.set_integer(steps, "NSteps", frame_count);
    file.flush();
}

}  // namespace

double grid_spacing(PositionGrid grid)
{
    if (grid == PositionGrid::lossless) return 0;
    return std::ldexp(1.0, grid == PositionGrid::fine_8um ? -17 : -14);
}

Eigen::Vector3f written_position(const Vec3& position, double spacing)
{
    if (spacing == 0) return position.cast<float>();
    const Vec3 rounded = (position / spacing).array().round() * spacing;
    return rounded.cast<float>();
}

struct TrajectoryWriter::Datasets {
    Hdf5File file;
    Hdf5Id points;
    std::vector<Hdf5Id> columns;  ///< In the order of frame_columns.

    explicit Datasets(const std::string& path) : file(path, Hdf5Access::append), points(open_points(file))
    {
        for (const FrameColumn& column : frame_columns) columns.push_back(file.open_dataset(column.name));
    }
};

TrajectoryWriter::TrajectoryWriter(TrajectoryWriter&&) noexcept = default;
TrajectoryWriter& TrajectoryWriter::operator=(TrajectoryWriter&&) noexcept = default;
TrajectoryWriter::~TrajectoryWriter() = default;

TrajectoryWriter::TrajectoryWriter(const std::string& path, const TrajectoryLayout& layout, std::vector<double> times)
    : path_(path), point_count_(layout.point_count), triangle_count_(int(layout.triangles.size())),
      spacing_(grid_spacing(layout.grid)), has_second_name_(put_second_name(path)), times_(std::move(times)),
      buffer_(3 * layout.panel.size()), open_(std::make_unique<Datasets>(path))
{
    write_index_file();
}

TrajectoryWriter TrajectoryWriter::create(const std::string& path, const TrajectoryLayout& layout)
{
    put_header(path, layout);
    return {path, layout, {}};
}

TrajectoryWriter TrajectoryWriter::resume(const std::string& path, int keep_frames)
{
    TemporaryFile temporary(path);
    const TrajectoryReader old(path);
    if (keep_frames < 0 || keep_frames > old.frame_count())
        throw InputError({path, 0, 0, {}}, std::to_string(old.frame_count()) + " frames",
                         "at least the " + std::to_string(keep_frames) + " frames of the checkpoint");
    write_header(temporary.name(), old.layout());
    copy_frames(old, temporary.name(), keep_frames);
    temporary.move_into_place();
    std::vector<double> times;
    for (int frame = 0; frame < keep_frames; ++frame) times.push_back(old.scalars(frame).time);
    return {path, old.layout(), std::move(times)};
}

void TrajectoryWriter::write_frame(std::span<const Vec3> positions, const FrameScalars& scalars)
{
    if (!open_) throw std::logic_error("trajectory: a frame after the end");
    if (int(positions.size()) != point_count_) throw std::invalid_argument("trajectory: positions differ in number");
    if (!std::isfinite(scalars.time)) throw std::runtime_error("trajectory: the time of a frame is not finite");
    for (std::size_t point = 0; point < positions.size(); ++point) {
        if (!positions[point].allFinite())
            throw std::runtime_error("trajectory: the position of vertex " + std::to_string(point) +
                                     " at t = " + std::to_string(scalars.time) + " s is not finite");
        const Eigen::Vector3f written = written_position(positions[point], spacing_);
        for (int axis = 0; axis < 3; ++axis) buffer_[3 * point + std::size_t(axis)] = written[axis];
    }
    const int frame = frame_count();
    const std::array<hsize_t, 2> start{hsize_t(frame) * hsize_t(point_count_), 0}, count{hsize_t(point_count_), 3};
    const Hdf5Id& dataset = open_->points;
    lengthen_points(dataset, frame + 1, point_count_);
    const Hdf5Id target(H5Dget_space(dataset), H5Sclose, points);
    require_hdf5(H5Sselect_hyperslab(target, H5S_SELECT_SET, start.data(), nullptr, count.data(), nullptr), points);
    const Hdf5Id source(H5Screate_simple(2, count.data(), nullptr), H5Sclose, points);
    require_hdf5(H5Dwrite(dataset, H5T_NATIVE_FLOAT, source, target, H5P_DEFAULT, buffer_.data()), points);
    append_row(scalars);
    times_.push_back(scalars.time);
    if (std::chrono::steady_clock::now() - index_written_ > index_interval) write_index_file();
}

void TrajectoryWriter::append_row(const FrameScalars& scalars)
{
    const int frame = frame_count();
    const auto rows = frame_rows(frame, point_count_, scalars);
    for (std::size_t column = 1; column < rows.size(); ++column)
        write_row(open_->columns[column], frame_columns[column], frame, rows[column]);
    open_->file.flush();
    write_row(open_->columns[0], frame_columns[0], frame, rows[0]);
    open_->file.set_integer(steps, "NSteps", frame + 1);
    open_->file.flush();
}

void TrajectoryWriter::write_index_file()
{
    try {
        write_xdmf(index_path(path_), {file_name(path_), point_count_, triangle_count_, times_});
    } catch (const WriteError& error) {
        if (error.error() != ENOENT) throw;  // else the folder is just being moved, and the next time is soon
    }
    index_written_ = std::chrono::steady_clock::now();
}

void TrajectoryWriter::finish()
{
    if (!open_) return;
    write_positions_view(open_->file, frame_count(), point_count_);
    open_->file.flush();
    open_.reset();
    write_index_file();
}

}  // namespace selvage
