#include "validation/fuzz/targets.hpp"

#include <filesystem>
#include <fstream>
#include <sstream>

#include "host/scene/scene_model.hpp"
#include "io/content_hash.hpp"
#include "io/pattern/pattern_json.hpp"
#include "io/run/checkpoint.hpp"
#include "io/run/trajectory.hpp"
#include "io/scene/fabric_table.hpp"
#include "io/scene/presets.hpp"
#include "io/scene/read_scene.hpp"
#include "validation/fuzz/resumed_run.hpp"
#include "validation/measure/square_layout.hpp"

namespace selvage {
namespace {

std::string repeated(const std::string& text, int times)
{
    std::string result;
    for (int k = 0; k < times; ++k) result += text;
    return result;
}

std::string text_of(const std::string& path)
{
    std::ostringstream text;
    text << std::ifstream(path, std::ios::binary).rdbuf();
    return text.str();
}

void write(const std::string& path, const std::string& text) { std::ofstream(path, std::ios::binary) << text; }

std::vector<std::string> presets(std::string_view folder)
{
    std::vector<std::string> texts;
    for (const PresetFile& file : preset_files())
        if (file.path.starts_with(folder)) texts.emplace_back(file.text);
    return texts;
}

std::vector<std::string> scene_corpus()
{
    std::vector<std::string> corpus = presets("scenes/");
    corpus.push_back(
        "[[sheet]]\nresolution = 9\nfabric = \"thin\"\n[fabric.thin]\nbase = \"silk\"\n"
        "stretch_weft_curve = [[0.01, 3.0], [0.05, 30.0]]\n[[body]]\nshape = \"sphere\"\n"
        "[[body.keyframe]]\ntime = 1\ntranslation = [0, 0, 1]\n[pins]\nsheet = \"corners\"\n"
        "[[pins.motion]]\ngroup = \"corners\"\nvelocity = [0, 0, 1]\n[solver]\nuntil = 1\n");
    corpus.push_back("a = " + repeated("[", 30000) + repeated("]", 30000));
    corpus.push_back("a" + repeated(".a", 20000) + " = 1");
    corpus.push_back(repeated("[a]\n", 3) + repeated("x = {a = ", 5000));
    return corpus;
}

std::vector<std::string> pattern_corpus()
{
    return {R"({"pattern": {"panels": {
  "front": {"translation": [0, 10, 20], "rotation": [0, 0, 0], "vertices": [[0, 0], [30, 0], [30, 20], [0, 20]],
    "edges": [{"endpoints": [0, 1]}, {"endpoints": [1, 2], "curvature": {"type": "quadratic", "params": [[0.5, 0.1]]}},
              {"endpoints": [2, 3], "curvature": {"type": "cubic", "params": [[0.3, 0.1], [0.6, 0.1]]}},
              {"endpoints": [3, 0], "curvature": {"type": "circle", "params": [15, 0, 1]}}]},
  "back": {"translation": [0, 10, -20], "rotation": [0, 180, 0], "vertices": [[0, 0], [30, 0], [15, 20]],
    "edges": [{"endpoints": [0, 1], "curvature": [0.5, -0.1]}, {"endpoints": [1, 2]}, {"endpoints": [2, 0]}]}},
  "stitches": [[{"panel": "front", "edge": 0}, {"panel": "back", "edge": 1}],
               [{"panel": "front", "edge": 1}, {"panel": "back", "edge": 2}, "right_wrong"]]},
 "properties": {"units_in_meter": 100, "curvature_coords": "relative", "normalize_panel_translation": false}})",
            R"({"pattern": {"panels": {}, "stitches": []}, "properties": {"units_in_meter": 1}})",
            repeated("[", 60000),
            repeated("{\"a\":", 60000),
            "/* note */ {} // more",
            "{\"pattern\": {\"panels\": " + repeated("[", 60000) + repeated("]", 60000) + "}}"};
}

// A grid of quads with texture coordinates, as OBJ.
std::string grid(int side, bool with_texture)
{
    std::ostringstream text;
    text << "# grid\no grid\n";
    for (int k = 0; k < side * side; ++k) text << "v " << 0.1 * (k % side) << ' ' << 0.1 * (k / side) << " 1\n";
    for (int k = 0; with_texture && k < side * side; ++k)
        text << "vt " << 0.1 * (k % side) << ' ' << 0.1 * (k / side) << '\n';
    for (int row = 0; row + 1 < side; ++row)
        for (int column = 0; column + 1 < side; ++column) {
            text << 'f';
            for (const int k : {row * side + column, row * side + column + 1, (row + 1) * side + column + 1,
                                (row + 1) * side + column}) {
                text << ' ' << k + 1;
                if (with_texture) text << '/' << k + 1;
            }
            text << '\n';
        }
    return text.str();
}

std::string box(double size)
{
    std::ostringstream text;
    text << "g box\n";
    for (int k = 0; k < 8; ++k)
        text << "v " << size * (k & 1) << ' ' << size * (k >> 1 & 1) << ' ' << size * (k >> 2) << '\n';
    text << "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf -7 -5 -1 -3\n";
    return text.str();
}

std::vector<std::string> sheet_corpus()
{
    const std::string sewn =
        "o left\nv 0 0 0\nv 1 0 0\nv 1 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nf 1/1 2/2 3/3\n"
        "o right\nv 2 0 0\nvt 5 0\nvt 6 0\nvt 5 1\nf 2/4 4/5 3/6\n";
    return {grid(4, true),
            grid(3, false),
            sewn,
            "v 0 0 0\nv 1 0 0\nv 2 1 0\nv 0.5 0.2 0\nv 0 1 0\nf 1 2 3 4 5\n",
            "v 0 0 0\rv 1 0 0\rv 0 1 0\rf 1 2 3\r",
            "v 1 2 3\n" + repeated("f 1", 3000) + "\n"};
}

// Reads a scene that names the input, so that everything is examined that a run would.
std::function<void(const std::string&)> by_scene(const std::string& folder, const std::string& name,
                                                 const std::string& text)
{
    const std::string scene = folder + "/" + name;
    write(scene, text);
    return [scene](const std::string&) { build_scene_model(read_scene(scene, {})); };
}

std::vector<std::string> run_corpus(const std::string& folder)
{
    TrajectoryLayout layout = square_layout(), many = layout;
    layout.scene_text = "[[sheet]]\nresolution = 5\n" + repeated("# a long scene\n", 300);
    for (int k = 0; k < 5000; ++k)
        many.panel_names.push_back("panel " + std::to_string(k));  // more than attributes hold
    std::vector<std::string> corpus;
    const std::string path = folder + "/corpus.h5";
    for (const int frames : {0, 2, 70, 1}) {
        TrajectoryWriter writer = TrajectoryWriter::create(path, frames == 1 ? many : layout);
        for (int frame = 0; frame < frames; ++frame)
            writer.write_frame(std::vector<Vec3>(5, Vec3(0.1 * frame, 1, 2)), {0.04 * frame, 1, 2, 0.5, 0.1, 3, 4});
        writer.finish();
        corpus.push_back(text_of(path));
    }
    for (const char* name : {"/corpus.h5", "/corpus.vtkhdf", "/corpus.xdmf"}) std::filesystem::remove(folder + name);
    return corpus;
}

std::vector<std::string> checkpoint_corpus(const std::string& folder)
{
    Checkpoint checkpoint;
    checkpoint.reals = {{"positions", std::vector<double>(300, 0.25)}, {"none", {}}, {"time", {0.5}}};
    checkpoint.integers = {{"steps", {7}}, {"pairs", std::vector<int>(100, 3)}};
    checkpoint.words = {{"scene", "builtin:sphere"}, {"stage", "drape"}};
    const std::string path = folder + "/corpus.h5";
    write_checkpoint(path, checkpoint);
    const std::vector<std::string> corpus{text_of(path)};
    std::filesystem::remove(path);
    return corpus;
}

// A checkpoint ends with these words and a hash of all before them.
void seal_checkpoint(std::string& input)
{
    const std::string words = "selvage checksum ";
    if (const std::size_t at = input.rfind(words); at != std::string::npos) input.resize(at);
    ContentHash hash;
    hash.add(input);
    input += words + hash.text();
}

void read_run(const std::string& path)
{
    const TrajectoryReader run(path);
    for (int frame = 0; frame < run.frame_count(); ++frame) {
        run.read_frame(frame);
        run.read_raw_frame(frame);
    }
}

}  // namespace

std::vector<FuzzTarget> fuzz_targets(const std::string& folder)
{
    const std::string ground = "[[sheet]]\nresolution = 3\n";
    write(folder + "/pose_1.obj", box(0.3));
    std::vector<FuzzTarget> targets;
    targets.push_back(
        {"scene", "input.toml", scene_corpus(), false, [](const std::string& path) { read_scene(path, {}); }});
    targets.push_back({"fabric", "input.toml", presets("fabrics/"), false,
                       [](const std::string& path) { read_fabrics(text_of(path), path); }});
    targets.push_back({"pattern", "input.json", pattern_corpus(), false,
                       [](const std::string& path) { read_pattern_json(path, {}); }});
    targets.push_back({"sheet", "sheet.obj", sheet_corpus(), false,
                       by_scene(folder, "sheet.toml", "[[sheet]]\nshape = \"mesh\"\nmesh = \"sheet.obj\"\n")});
    targets.push_back({"body",
                       "body.obj",
                       {box(0.3), grid(3, false)},
                       false,
                       by_scene(folder, "body.toml", ground + "[[body]]\nmesh = \"body.obj\"\n")});
    targets.push_back({"sequence",
                       "pose_2.obj",
                       {box(0.3), box(0.31)},
                       false,
                       by_scene(folder, "sequence.toml", ground + "[[body]]\nsequence = \"pose_*.obj\"\n")});
    targets.push_back({"run", "input.h5", run_corpus(folder), true, read_run});
    targets.push_back({"checkpoint", "checkpoint.h5", checkpoint_corpus(folder), true,
                       [](const std::string& path) { read_checkpoint(path); }, seal_checkpoint});
    targets.push_back({"resume", "checkpoint.h5", resumed_corpus(folder), true, go_on_from, seal_checkpoint});
    return targets;
}

}  // namespace selvage
