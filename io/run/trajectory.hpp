#pragma once
#include <array>
#include <chrono>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "io/choices.hpp"
#include "io/geometry.hpp"

namespace selvage {

class Hdf5Reader;

/// Returns the distance of neighbouring grid values [m]: 0, 2^-17 or 2^-14. A power of two keeps rounded positions
/// exact in float32, and they compress well.
double grid_spacing(PositionGrid grid);

/// Returns a position as it is written: rounded to the grid, then to single precision [m].
/// @param spacing  see grid_spacing
Eigen::Vector3f written_position(const Vec3& position, double spacing);

/// The data of a run that do not change from frame to frame.
struct TrajectoryLayout {
    int point_count = 0;
    std::vector<Face> triangles;                           ///< Point indices; some points may belong to none.
    std::vector<Vec2> panel_coordinates;                   ///< Per point: (weft, warp) [m].
    std::vector<int> panel;                                ///< Per point: index into panel_names.
    std::vector<std::array<double, 3>> rest_edge_lengths;  ///< Per triangle: edges 01, 12, 20 [m].
    /// Per triangle: (weft, warp) of its corners in its own panel [m], written in single precision. Sewn panels share
    /// points, so that the coordinates per point are those of one panel only. Empty: a file of an earlier version.
    std::vector<std::array<Vec2, 3>> rest_corners;
    std::vector<int> triangle_panel;             ///< Per triangle: index into panel_names; or empty as well.
    std::vector<std::array<int, 2>> seam_pairs;  ///< Points that are sewn to each other.
    std::vector<std::string> panel_names;
    std::string scene_text;  ///< The whole scene as run.
    std::string scene_file;  ///< Absolute path of the scene, or builtin:NAME.
    std::string version;     ///< Version of the program that writes the file.
    PositionGrid grid = PositionGrid::fine_8um;
};

/// The scalars of a frame. NaN stands for unknown, except for the time.
struct FrameScalars {
    double time = 0;            ///< Simulated [s].
    double kinetic_energy = 0;  ///< [J]
    double total_energy = 0;    ///< [J]
    double residual = 0;        ///< Relative force residual [1].
    double wall_seconds = 0;    ///< Wall time since the start of the run [s].
    int contacts = 0;
    int iterations = 0;  ///< Newton iterations since the previous frame.
};

/// Writes run.h5, a temporal VTKHDF PolyData file, and beside it run.xdmf and run.vtkhdf, a second name (hard link) of
/// the same file: programs that go by the ending take it for VTKHDF. The second name follows when the file is replaced;
/// after a kill in between it is the file before, until the run is resumed.
///
/// A frame is committed when write_frame returns. A file whose writer was killed at any moment can be opened and holds
/// every committed frame; their number is Steps@NSteps. It may also hold parts of one more frame.
class TrajectoryWriter {
public:
    /// Creates a file without frames. An existing file is replaced once the new one can be opened by a reader.
    /// @throws InputError if the place cannot be written; std::invalid_argument if the layout contradicts itself.
    static TrajectoryWriter create(const std::string& path, const TrajectoryLayout& layout);

    /// Continues a file, also one whose writer was killed: keeps its first frames and appends to them. The kept frames
    /// are copied to a new file, which then replaces the old one.
    /// @param keep_frames  frames to keep, in [0, committed frames]
    /// @throws InputError if the file is not a run or holds fewer frames.
    static TrajectoryWriter resume(const std::string& path, int keep_frames);

    TrajectoryWriter(TrajectoryWriter&&) noexcept;
    TrajectoryWriter& operator=(TrajectoryWriter&&) noexcept;
    ~TrajectoryWriter();

    /// Appends and commits a frame.
    /// @param positions  [m], one per point
    /// @throws std::runtime_error naming the vertex if a position is not finite; nothing is written then.
    void write_frame(std::span<const Vec3> positions, const FrameScalars& scalars);

    /// False where the file system has no hard links, so that there is no run.vtkhdf.
    bool has_second_name() const { return has_second_name_; }
    /// Tells where the file is after its folder has been moved.
    void moved_to(const std::string& path) { path_ = path; }

    int frame_count() const { return int(times_.size()); }
    double last_time() const { return times_.empty() ? 0 : times_.back(); }  ///< Time of the last committed frame [s].

    /// Adds the virtual dataset /selvage/positions, writes the final run.xdmf and closes the file.
    void finish();

private:
    TrajectoryWriter(const std::string& path, const TrajectoryLayout& layout, std::vector<double> times);
    void append_row(const FrameScalars& scalars);  ///< Commits the frame.
    void write_index_file();

    std::string path_;
    int point_count_, triangle_count_;
    double spacing_;
    bool has_second_name_;
    std::vector<double> times_;  ///< Times of the committed frames [s].
    std::chrono::steady_clock::time_point index_written_{};
    std::vector<float> buffer_;  ///< Rounded positions of one frame.
    struct Datasets;
    std::unique_ptr<Datasets> open_;  ///< Null once the file is finished.
};

/// Reads run.h5, finished or not.
class TrajectoryReader {
public:
    /// @throws InputError if the file is missing, not HDF5, or not a run.
    explicit TrajectoryReader(const std::string& path);
    TrajectoryReader(TrajectoryReader&&) noexcept;
    ~TrajectoryReader();

    const TrajectoryLayout& layout() const { return layout_; }
    int frame_count() const { return int(scalars_.size()); }  ///< Number of committed frames.
    const FrameScalars& scalars(int frame) const { return scalars_.at(std::size_t(frame)); }

    /// Returns the positions [m] of a frame in [0, frame_count).
    /// @throws InputError if there is no such frame or it cannot be read.
    std::vector<Vec3> read_frame(int frame) const;

    /// Returns the compressed bytes of a frame.
    std::vector<unsigned char> read_raw_frame(int frame) const;

private:
    void check_frame(int frame) const;

    struct Frames;
    std::unique_ptr<Hdf5Reader> file_;
    std::unique_ptr<Frames> frames_;
    TrajectoryLayout layout_;
    std::vector<FrameScalars> scalars_;
};

}  // namespace selvage
