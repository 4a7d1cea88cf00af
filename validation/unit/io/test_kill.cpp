#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include "io/run/trajectory.hpp"
#include "validation/unit/catch.hpp"
#include "validation/unit/scratch_file.hpp"

using namespace selvage;

namespace {

/// One change of the file: bytes at an address, or a new length.
struct Change {
    std::size_t address;
    std::vector<char> bytes;  ///< Empty: the file's length becomes `address`.
    int committed;            ///< Frames that write_frame had returned for by then.
};

/// What the process does to one file, in order. The kernel completes each call unless the process is killed, which it
/// looks for between pages: a kill at any moment leaves what some first part of these changes makes.
struct Recording {
    std::vector<Change> changes;
    int committed = 0;
    ino_t file = 0;  ///< 0: nothing is recorded.

    bool is_recorded(int descriptor) const
    {
        struct stat status {};
        return file != 0 && fstat(descriptor, &status) == 0 && status.st_ino == file;
    }
    void write(std::size_t address, const void* data, std::size_t size)
    {
        constexpr std::size_t page = 4096;
        const char* from = static_cast<const char*>(data);
        while (size > 0) {
            const std::size_t part = std::min(size, page - address % page);
            changes.push_back({address, {from, from + part}, committed});
            from += part, address += part, size -= part;
        }
    }
};

Recording recording;

}  // namespace

// These stand in front of the C library's functions of the same names, also for shared libraries.
extern "C" ssize_t pwrite(int descriptor, const void* data, std::size_t size, off_t address)
{
    if (recording.is_recorded(descriptor)) recording.write(std::size_t(address), data, size);
    return syscall(SYS_pwrite64, descriptor, data, size, address);
}

extern "C" ssize_t pwrite64(int descriptor, const void* data, std::size_t size, off64_t address)
{
    return pwrite(descriptor, data, size, address);
}

extern "C" int ftruncate(int descriptor, off_t length) noexcept
{
    if (recording.is_recorded(descriptor)) recording.changes.push_back({std::size_t(length), {}, recording.committed});
    return int(syscall(SYS_ftruncate, descriptor, length));
}

extern "C" int ftruncate64(int descriptor, off64_t length) noexcept { return ftruncate(descriptor, length); }

namespace {

constexpr int point_count = 5;

TrajectoryLayout strip()
{
    TrajectoryLayout layout;
    layout.point_count = point_count;
    layout.triangles = {{0, 1, 2}, {1, 3, 2}, {2, 3, 4}};
    layout.panel_coordinates = {{0, 0}, {1, 0}, {0, 1}, {1, 1}, {0, 2}};
    layout.panel = {0, 0, 0, 0, 0};
    layout.rest_edge_lengths = {{1, 1.5, 1}, {1, 1, 1.5}, {1, 1, 1.5}};
    layout.panel_names = {"strip"};
    layout.scene_text = "[sheet]\n";
    layout.version = "1.2.3";
    layout.grid = PositionGrid::lossless;
    return layout;
}

std::vector<Vec3> positions(int frame)
{
    std::vector<Vec3> x;
    for (int point = 0; point < point_count; ++point) x.emplace_back(point, frame, 0.25 * point * frame);
    return x;
}

FrameScalars scalars(int frame) { return {0.25 * frame, 1.0 * frame, 2.0, 0.5, 0.1 * frame, frame, 7}; }

/// Says what is wrong with a file that should hold `committed` frames or one more; empty: nothing.
std::string fault(const std::string& path, int committed)
try {
    const TrajectoryReader run(path);
    const int count = run.frame_count();
    if (count != committed && count != committed + 1) return std::to_string(count) + " frames";
    for (int frame = 0; frame < count; ++frame)
        if (run.read_frame(frame) != positions(frame) || run.scalars(frame).time != scalars(frame).time ||
            run.scalars(frame).contacts != frame)
            return "frame " + std::to_string(frame) + " differs";
    return {};
} catch (const std::exception& error) {
    return error.what();
}

void make(const Change& change, const std::string& path)
{
    if (change.bytes.empty()) return std::filesystem::resize_file(path, change.address);
    std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
    file.seekp(std::streamoff(change.address));
    file.write(change.bytes.data(), std::streamsize(change.bytes.size()));
    REQUIRE(file.flush());
}

std::string bytes_of(const std::string& path)
{
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

/// Writes frames to a new file and finishes it.
/// @param start  gets the file as it was before the first frame
/// @return all changes from there on
std::vector<Change> record_run(const std::string& path, const std::string& start, int frames)
{
    TrajectoryWriter writer = TrajectoryWriter::create(path, strip());
    std::filesystem::copy_file(path, start);
    struct stat status {};
    REQUIRE(stat(path.c_str(), &status) == 0);
    recording = {{}, 0, status.st_ino};
    while (writer.frame_count() < frames) {
        writer.write_frame(positions(writer.frame_count()), scalars(writer.frame_count()));
        recording.committed = writer.frame_count();
    }
    writer.finish();
    return std::exchange(recording, {}).changes;
}

}  // namespace

TEST_CASE("a file whose writer is killed at any moment opens and holds every committed frame")
{
    const ScratchFolder folder;
    const std::string path = folder.path("run.h5"), killed = folder.path("killed.h5");
    const int frames = 70;  // The index of their chunks gets a second level with the 65th.
    const std::vector<Change> changes = record_run(path, killed, frames);
    for (std::size_t k = 0; k < changes.size(); ++k) {
        make(changes[k], killed);
        INFO("killed after change " << k + 1 << " of " << changes.size());
        INFO(changes[k].committed << " frames were committed");
        REQUIRE(fault(killed, changes[k].committed) == "");
    }
    CHECK(bytes_of(killed) == bytes_of(path));  // No change has passed by the recording.
}
