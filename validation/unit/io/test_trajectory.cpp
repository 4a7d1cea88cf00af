#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>

#include <unistd.h>
#include <nlohmann/json.hpp>

#include "io/errors.hpp"
#include "io/run/checkpoint.hpp"
#include "io/run/describe.hpp"
#include "io/run/hdf5_reader.hpp"
#include "io/run/progress.hpp"
#include "io/run/summary.hpp"
#include "io/run/trajectory.hpp"
#include "io/run/xdmf.hpp"
#include "validation/measure/square_layout.hpp"
#include "validation/unit/catch.hpp"

using namespace selvage;

namespace {

/// A temporary folder that is removed at the end of the test.
struct Folder {
    std::filesystem::path path = std::filesystem::temp_directory_path() / ("selvage_run_" + std::to_string(getpid()));
    Folder() { std::filesystem::create_directories(path); }
    ~Folder() { std::filesystem::remove_all(path); }
    std::string file(const std::string& name) const { return (path / name).string(); }
};

std::string text_of(const std::string& path)
{
    std::ostringstream text;
    text << std::ifstream(path).rdbuf();
    return text.str();
}

TrajectoryLayout square(PositionGrid grid)
{
    TrajectoryLayout layout = square_layout();
    layout.scene_text = "[sheet]\n" + std::string(70000, '#');  // Longer than an HDF5 object header.
    layout.grid = grid;
    return layout;
}

std::vector<Vec3> positions(int frame)
{
    std::vector<Vec3> x;
    for (int point = 0; point < 5; ++point)
        x.emplace_back(std::sin(point + 0.3 * frame), 0.1 * point - frame, std::cos(1.7 * point + frame));
    return x;
}

FrameScalars scalars(int frame) { return {0.04 * frame, 1.0 * frame, 2.0, 0.5, 0.1 * frame, frame, 7}; }

void write_frames(TrajectoryWriter& writer, int end)
{
    while (writer.frame_count() < end)
        writer.write_frame(positions(writer.frame_count()), scalars(writer.frame_count()));
}

void check_frames(const std::string& path, int count, double tolerance)
{
    const TrajectoryReader run(path);
    REQUIRE(run.frame_count() == count);
    for (int frame = 0; frame < count; ++frame) {
        const std::vector<Vec3> expected = positions(frame), found = run.read_frame(frame);
        for (std::size_t point = 0; point < expected.size(); ++point)
            CHECK((found[point] - expected[point]).cwiseAbs().maxCoeff() <= tolerance);
        CHECK(run.scalars(frame).time == scalars(frame).time);
        CHECK(run.scalars(frame).contacts == frame);
    }
}

}  // namespace

TEST_CASE("a trajectory is read back as it was written")
{
    const Folder folder;
    const std::string path = folder.file("run.h5");
    const TrajectoryLayout layout = square(PositionGrid::lossless);
    TrajectoryWriter writer = TrajectoryWriter::create(path, layout);
    write_frames(writer, 4);
    writer.finish();
    check_frames(path, 4, 1e-6);

    const TrajectoryReader run(path);
    CHECK(run.layout().triangles == layout.triangles);
    CHECK(run.layout().panel_coordinates == layout.panel_coordinates);
    CHECK(run.layout().panel == layout.panel);
    CHECK(run.layout().rest_edge_lengths == layout.rest_edge_lengths);
    CHECK(run.layout().rest_corners == layout.rest_corners);
    CHECK(run.layout().triangle_panel == layout.triangle_panel);
    CHECK(run.layout().seam_pairs == layout.seam_pairs);
    CHECK(run.layout().panel_names == layout.panel_names);
    CHECK(run.layout().scene_text == layout.scene_text);
    CHECK(run.layout().grid == PositionGrid::lossless);
    CHECK(run.scalars(3).iterations == 7);
    CHECK_THROWS_AS(run.read_frame(4), InputError);
    CHECK(nlohmann::json::parse(describe_run(path, true))["frames"] == 4);
}

TEST_CASE("a run file has the layout that VTK and h5py users rely on")
{
    const Folder folder;
    const std::string path = folder.file("run.h5");
    TrajectoryWriter writer = TrajectoryWriter::create(path, square(PositionGrid::fine_8um));
    write_frames(writer, 3);
    writer.finish();

    CHECK(text_of(path).at(8) == 0);  // Version of the superblock.
    const Hdf5Reader file(path);
    CHECK(file.integer("/VTKHDF/Steps", "NSteps") == 3);
    CHECK(file.shape("/VTKHDF/Points") == Hdf5Reader::Shape{15, 3});
    CHECK(file.shape("/selvage/positions") == Hdf5Reader::Shape{3, 5, 3});
    CHECK(file.read_integers("/VTKHDF/Steps/PointOffsets") == std::vector<std::int64_t>{0, 5, 10});
    CHECK(file.read_integers("/VTKHDF/Steps/NumberOfParts") == std::vector<std::int64_t>{1, 1, 1});
    CHECK(file.shape("/VTKHDF/Steps/ConnectivityIdOffsets") == Hdf5Reader::Shape{3, 4});
    CHECK(file.shape("/VTKHDF/Steps/CellDataOffsets/rest_edge_lengths") == Hdf5Reader::Shape{3});
    CHECK(file.shape("/VTKHDF/CellData/rest_corners") == Hdf5Reader::Shape{2, 6});
    CHECK(file.shape("/selvage/rest_corners") == Hdf5Reader::Shape{2, 3, 2});
    CHECK(file.read_integers("/VTKHDF/Polygons/Offsets") == std::vector<std::int64_t>{0, 3, 6});
    for (const char* empty : {"Vertices", "Lines", "Strips"})
        CHECK(file.read_integers(std::string("/VTKHDF/") + empty + "/Offsets") == std::vector<std::int64_t>{0});
}

TEST_CASE("a trajectory has a second name that VTK programs know, also once it has been continued")
{
    const Folder folder;
    const std::string path = folder.file("run.h5"), second = folder.file("run.vtkhdf");
    std::ofstream(second) << "something older";
    {
        TrajectoryWriter writer = TrajectoryWriter::create(path, square(PositionGrid::lossless));
        CHECK(writer.has_second_name());
        CHECK(std::filesystem::equivalent(path, second));
        write_frames(writer, 3);
    }
    TrajectoryWriter writer = TrajectoryWriter::resume(path, 2);
    CHECK(std::filesystem::equivalent(path, second));
    write_frames(writer, 4);
    writer.finish();
    check_frames(second, 4, 1e-6);
    for (const auto& entry : std::filesystem::directory_iterator(folder.path))
        CHECK(entry.path().extension() != ".partial");
}

TEST_CASE("rounding moves positions by at most half a grid spacing and onto the grid")
{
    const Folder folder;
    for (const PositionGrid grid : {PositionGrid::fine_8um, PositionGrid::coarse_60um}) {
        const double spacing = grid_spacing(grid);
        TrajectoryWriter writer = TrajectoryWriter::create(folder.file("run.h5"), square(grid));
        write_frames(writer, 2);
        writer.finish();
        check_frames(folder.file("run.h5"), 2, spacing / 2);
        for (const Vec3& x : TrajectoryReader(folder.file("run.h5")).read_frame(1))
            for (int axis = 0; axis < 3; ++axis) CHECK(std::fmod(x[axis], spacing) == 0);
    }
    CHECK(grid_spacing(PositionGrid::fine_8um) == std::ldexp(1.0, -17));
}

TEST_CASE("a position that is not finite is refused and leaves the file as it was")
{
    const Folder folder;
    const std::string path = folder.file("run.h5");
    TrajectoryWriter writer = TrajectoryWriter::create(path, square(PositionGrid::fine_8um));
    write_frames(writer, 2);
    std::vector<Vec3> broken = positions(2);
    for (const double value : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
        broken[3].y() = value;
        CHECK_THROWS_WITH(writer.write_frame(broken, scalars(2)), contains_text("vertex 3"));
    }
    check_frames(path, 2, 1e-5);
    write_frames(writer, 3);
    writer.finish();
    check_frames(path, 3, 1e-5);
}

TEST_CASE("every frame is readable as soon as it is written")
{
    const Folder folder;
    const std::string path = folder.file("run.h5"), copy = folder.file("killed.h5");
    TrajectoryWriter writer = TrajectoryWriter::create(path, square(PositionGrid::fine_8um));
    for (int frame = 0; frame < 140; ++frame) {  // The index splits at 64 and 122 frames.
        write_frames(writer, frame + 1);
        if (frame % 7 > 0 && frame != 64) continue;
        std::filesystem::copy_file(path, copy, std::filesystem::copy_options::overwrite_existing);
        const TrajectoryReader run(copy);
        REQUIRE(run.frame_count() == frame + 1);
        CHECK((run.read_frame(frame)[2] - positions(frame)[2]).norm() < 1e-5);
        CHECK((run.read_frame(frame / 2)[2] - positions(frame / 2)[2]).norm() < 1e-5);
    }
}

TEST_CASE("resuming keeps the wanted frames and appends, also after a run that did not end")
{
    const Folder folder;
    const std::string path = folder.file("run.h5"), killed = folder.file("killed.h5");
    {
        TrajectoryWriter writer = TrajectoryWriter::create(path, square(PositionGrid::fine_8um));
        write_frames(writer, 9);
        std::filesystem::copy_file(path, killed);
        writer.finish();
    }
    for (const std::string& file : {path, killed}) {
        CHECK_THROWS_AS(TrajectoryWriter::resume(file, 10), InputError);
        TrajectoryWriter writer = TrajectoryWriter::resume(file, 6);
        CHECK(writer.frame_count() == 6);
        check_frames(file, 6, 1e-5);
        write_frames(writer, 8);
        writer.finish();
        check_frames(file, 8, 1e-5);
        CHECK(Hdf5Reader(file).shape("/selvage/positions").at(0) == 8);
        CHECK(Hdf5Reader(file).shape("/VTKHDF/Points").at(0) == 40);
    }
}

TEST_CASE("a file that is not a run is refused as input")
{
    const Folder folder;
    std::ofstream(folder.file("text.h5")) << "not HDF5";
    write_checkpoint(folder.file("other.h5"), {});
    for (const char* name : {"missing.h5", "text.h5", "other.h5"})
        CHECK_THROWS_AS(TrajectoryReader(folder.file(name)), InputError);
}

TEST_CASE("the index for ParaView names every frame with its time and rows")
{
    const Folder folder;
    TrajectoryWriter writer = TrajectoryWriter::create(folder.file("a&b.h5"), square(PositionGrid::fine_8um));
    write_frames(writer, 3);
    writer.finish();
    const std::string text = text_of(folder.file("a&b.xdmf"));
    CHECK(text.find("a&amp;b.h5:/VTKHDF/Points|10 0:1 1:5 3:15 3\n") != std::string::npos);
    CHECK(text.find("<Time Value=\"0.08\"/>") != std::string::npos);
    CHECK(text.find("|15 0:") == std::string::npos);
}

TEST_CASE("a summary holds every documented key, and null for unknown values")
{
    const nlohmann::json json = nlohmann::json::parse(summary_json({}));
    for (const char* key : {"status",
                            "scene",
                            "version",
                            "threads",
                            "precision",
                            "vertices",
                            "triangles",
                            "steps",
                            "frames",
                            "simulated_s",
                            "wall_s",
                            "phases",
                            "kernels",
                            "integrators",
                            "active",
                            "skipped",
                            "peak_memory_bytes",
                            "residual",
                            "energy",
                            "stretch",
                            "body",
                            "self",
                            "seams",
                            "panels",
                            "warnings",
                            "message"})
        CHECK(json.contains(key));
    for (const char* key : {"membrane_J", "bending_J", "gravity_J", "contact_J", "kinetic_J"})
        CHECK(json["energy"].contains(key));
    CHECK(json["residual"].is_null());
    CHECK(json["self"]["intersections"].is_null());

    RunSummary summary;
    summary.status = RunStatus::time_limit;
    summary.self_intersections = 0;
    summary.residual = 0.25;
    summary.kernels = {{"membrane", 3, 0.5, 0.4, 300, 9000}};
    summary.panels = {{"fr\xf6nt", 0.01, -0.02}};  // Latin-1, as in an old pattern file.
    const Folder folder;
    write_summary(folder.file("summary.json"), summary);
    const nlohmann::json read = nlohmann::json::parse(text_of(folder.file("summary.json")));
    CHECK(read["status"] == "time_limit");
    CHECK(read["self"]["intersections"] == 0);
    CHECK(read["residual"] == 0.25);
    CHECK(read["kernels"][0]["items"] == 300);
    CHECK(read["panels"][0]["boundary_error"] == -0.02);
}

TEST_CASE("a checkpoint is read back bit by bit, and a damaged one is refused")
{
    const Folder folder;
    const std::string path = folder.file("checkpoint.h5");
    Checkpoint written;
    written.reals = {{"x", {0.1, -1e-300, std::numeric_limits<double>::infinity()}}, {"empty", {}}};
    for (int k = 0; k < 1000; ++k) written.reals["velocity"].push_back(std::sin(k));
    written.integers = {{"step", {42}}, {"none", {}}};
    written.words = {{"scene", "[sheet]\nresolution = 3"}, {"blank", ""}};
    write_checkpoint(path, written);
    const Checkpoint read = read_checkpoint(path);
    CHECK(read.reals == written.reals);
    CHECK(read.integers == written.integers);
    CHECK(read.words == written.words);

    const std::string whole = text_of(path);
    CHECK_THROWS_AS(read_checkpoint(folder.file("missing.h5")), InputError);
    std::ofstream(path) << whole.substr(0, whole.size() / 2);
    CHECK_THROWS_AS(read_checkpoint(path), InputError);
    std::string damaged = whole;
    const double value = written.reals["velocity"][500];
    damaged.at(damaged.find(std::string(reinterpret_cast<const char*>(&value), 8))) ^= 1;
    std::ofstream(path) << damaged;
    CHECK_THROWS_AS(read_checkpoint(path), InputError);
}

TEST_CASE("progress lines are JSON, one per update, on the disk at once")
{
    const Folder folder;
    ProgressReport report({folder.file("progress.jsonl"), false, true, 2.0, 0});
    for (int step = 0; step < 5; ++step) {
        ProgressState state;
        state.phase = "draping";
        state.time = 0.1 * step;
        state.step = step;
        report.update(state);
        std::ifstream file(folder.file("progress.jsonl"));
        std::string line, last;
        int lines = 0;
        while (std::getline(file, line)) ++lines, last = line;
        CHECK(lines == step + 1);
        CHECK(nlohmann::json::parse(last)["step"] == step);
        CHECK(nlohmann::json::parse(last)["residual"].is_null());
    }
}

TEST_CASE("the estimate of the remaining time follows the simulated time or the residual's decay")
{
    EtaEstimate fixed(10, 0), decaying(std::numeric_limits<double>::infinity(), 1e-4);
    CHECK(std::isnan(fixed.seconds_left()));
    for (int k = 0; k <= 20; ++k) {
        fixed.add(2.0 * k, {"draping", 0.1 * k, k, NAN, 0});
        decaying.add(2.0 * k, {"draping", 0.1 * k, k, std::pow(10, -0.1 * k), 0});
    }
    CHECK(fixed.seconds_left() == Approx(8 * 20.0));
    CHECK(decaying.seconds_left() == Approx(40));  // From 1e-2 to 1e-4 at a decade in 20 s.
}
