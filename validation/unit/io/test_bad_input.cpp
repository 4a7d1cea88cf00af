#include <string>
#include <vector>

#include "io/errors.hpp"
#include "io/mesh/mesh_obj.hpp"
#include "io/pattern/pattern_json.hpp"
#include "io/scene/read_scene.hpp"
#include "io/scene/scene.hpp"
#include "validation/unit/catch.hpp"
#include "validation/unit/scratch_file.hpp"

using namespace selvage;

namespace {

template <class Action>
std::string message_of(Action action)
{
    try {
        action();
    } catch (const InputError& error) {
        return error.what();
    }
    return "no InputError";
}

void check_message(const std::string& message, const std::vector<std::string>& parts)
{
    INFO(message);
    for (const std::string& part : parts) {
        INFO(part);
        CHECK(message.find(part) != std::string::npos);
    }
}

std::string many(const std::string& text, int count)
{
    std::string all;
    for (int k = 0; k < count; ++k) all += text;
    return all;
}

struct BadText {
    std::string text;
    std::vector<std::string> message;  ///< Each must occur in the error's message.
};

void check_scenes(const std::vector<BadText>& scenes)
{
    const ScratchFolder folder;
    for (const BadText& bad : scenes) {
        const std::string path = folder.write("bad.toml", bad.text);
        const std::string message = message_of([&] { read_scene(path, {}); });
        check_message(message, {"bad.toml", "found ", "expected "});
        check_message(message, bad.message);
    }
}

void check_overrides(const std::vector<BadText>& overrides)
{
    for (const BadText& bad : overrides) {
        const std::string message =
            message_of([&] { read_scene("builtin:sphere", std::vector<std::string>{bad.text}); });
        check_message(message, {"--set " + bad.text, "found ", "expected "});
        check_message(message, bad.message);
    }
}

void check_patterns(const std::vector<BadText>& patterns)
{
    const ScratchFolder folder;
    for (const BadText& bad : patterns) {
        const std::string path = folder.write("bad.json", bad.text);
        const std::string message = message_of([&] { read_pattern_json(path, PatternConventions{}); });
        check_message(message, {"bad.json", "found ", "expected "});
        check_message(message, bad.message);
    }
}

// A triangle of 30 cm, sewn to a second one, with one passage replaced.
std::string pattern_with(const std::string& passage, const std::string& replacement)
{
    std::string text = R"({"pattern": {"panels": {
"front": {"translation": [0, 100, 20], "rotation": [0, 0, 0], "vertices": [[0, 0], [30, 0], [0, 30]],
  "edges": [{"endpoints": [0, 1]}, {"endpoints": [1, 2]}, {"endpoints": [2, 0]}]},
"back": {"translation": [0, 100, -20], "rotation": [0, 0, 0], "vertices": [[0, 0], [30, 0], [0, 30]],
  "edges": [{"endpoints": [0, 1]}, {"endpoints": [1, 2]}, {"endpoints": [2, 0]}]}},
"stitches": [[{"panel": "front", "edge": 0}, {"panel": "back", "edge": 1}]]},
"properties": {"units_in_meter": 100, "curvature_coords": "relative"}})";
    const std::size_t at = text.find(passage);
    REQUIRE(at != std::string::npos);
    return text.replace(at, passage.size(), replacement);
}

void check_objs(const std::vector<BadText>& objs)
{
    const ScratchFolder folder;
    for (const BadText& bad : objs) {
        const std::string path = folder.write("bad.obj", bad.text);
        const std::string message = message_of([&] { read_obj(path, LengthUnit::m, Axis::z); });
        check_message(message, {"bad.obj", "found ", "expected "});
        check_message(message, bad.message);
    }
}

}  // namespace

TEST_CASE("unknown and misspelt scene keys are refused with the nearest valid name")
{
    check_scenes({
        {"[[sheet]]\n[solver]\nstepp = 0.1\n", {":3:1:", "solver.stepp", "`step`"}},
        {"[[sheet]]\nresolutoin = 9\n", {":2:1:", "sheet[0].resolutoin", "`resolution`"}},
        {"[[sheet]]\n[solvr]\n", {":2:", "solvr", "`solver`"}},
        {"[[sheet]]\n[fabric.f]\nbase = \"cotton\"\nbendin_warp = 1\n",
         {":4:1:", "fabric.f.bendin_warp", "`bending_warp`"}},
        {"[[sheet]]\nfabric = \"cottn\"\n", {":2:10:", "sheet[0].fabric", "`cottn`", "`cotton`"}},
        {"[[sheet]]\n[fabric.f]\nbase = \"sikl\"\n", {":3:", "fabric.f.base", "`sikl`", "`silk`"}},
        {"[[sheet]]\n[output]\nprecision = \"9um\"\n", {":3:13:", "output.precision", "9um", "lossless", "`8um`"}},
        {"[[sheet]]\n[solver]\nuntil = \"equilibrum\"\n", {":3:9:", "solver.until", "`equilibrum`", "`equilibrium`"}},
    });
}

TEST_CASE("scene values of the wrong type or out of range are refused with the range and its unit")
{
    check_scenes({
        {"[garment]\npattern = \"builtin:tshirt\"\nresolution = 10\n",
         {":3:14:", "garment.resolution", "10", "0.0001 to 0.2 m", "0.01 m (10 mm)"}},
        {"[[sheet]]\n[fabric.f]\nbase = \"cotton\"\nareal_density = 150\n", {":4:", "0.15 kg/m^2 (150 g/m^2)"}},
        {"[[sheet]]\n[[body]]\nshape = \"mannequin\"\nstature = 0.172\n", {":4:", "0.8 to 2.5 m", "1.72 m"}},
        {"[[sheet]]\n[solver]\nstep = nan\n", {":3:8:", "solver.step", "nan", "1 s"}},
        {"[[sheet]]\n[solver]\nmax_time = inf\n", {":3:12:", "solver.max_time", "inf", " s"}},
        {"[[sheet]]\n[solver]\nthreads = 2.5\n", {":3:", "solver.threads", "2.5", "whole number"}},
        {"[[sheet]]\n[solver]\nthreads = 9223372036854775807\n", {":3:", "solver.threads", "1024"}},
        {"[[sheet]]\n[solver]\nstep = \"fast\"\n", {":3:", "solver.step", "fast", "a number"}},
        {"[[sheet]]\n[solver]\nuntil = -2\n", {":3:", "solver.until", "-2", " s"}},
        {"[[sheet]]\n[output]\nframes = 1\n", {":3:", "output.frames", "1", "true or false"}},
        {"[[sheet]]\ncenter = [0, 1]\n", {":2:", "sheet[0].center", "[ 0, 1 ]", "three numbers"}},
        {"[[sheet]]\ncenter = [0, 1, nan]\n", {":2:", "sheet[0].center", "three numbers"}},
        {"[sheet]\nwidth = 1\n", {":1:", "sheet", "[[sheet]]"}},
        {"solver = 3\n[[sheet]]\n", {":1:", "solver", "3", "[solver]"}},
        {"[[sheet]]\n[pins]\nvertices = \"1, x\"\n", {":3:", "pins.vertices", "`x`"}},
    });
}

TEST_CASE("scenes that do not fit together are refused")
{
    check_scenes({
        {"[solver]\nstep = 0.01\n", {"neither [garment] nor [[sheet]]"}},
        {"", {"neither [garment] nor [[sheet]]"}},
        {"[garment]\nresolution = 0.01\n", {"garment.pattern", "no file name"}},
        {"[garment]\npattern = \"missing.json\"\n", {":2:", "garment.pattern", "missing.json", "no such file"}},
        {"[[sheet]]\n[[body]]\nmesh = \"missing.obj\"\n", {":3:8:", "body[0].mesh", "missing.obj", "no such file"}},
        {"[[sheet]]\nshape = \"mesh\"\n", {"sheet[0].mesh", "no file name"}},
        {"[[sheet]]\n[[body]]\nname = \"a\"\nshape = \"plane\"\n[[body]]\nname = \"a\"\nshape = \"plane\"\n",
         {":6:", "body[1].name", "`a`"}},
        {"[[sheet]]\n[[body]]\nshape = \"plane\"\nnormal = [0, 0, 0]\n", {":4:", "body[0].normal", "direction"}},
        {"[[sheet]]\n[fabric.f]\nareal_density = 0.1\n", {":2:", "fabric.f.stretch_weft", "base"}},
        {"[[sheet]]\n[fabric.f]\nbase = \"cotton\"\nstretch_coupling = 300\n",
         {"fabric.f.stretch_coupling", "300", "277.5"}},
        {"[[sheet]]\n[fabric.f]\nbase = \"cotton\"\nshear = -1\n", {":4:", "fabric.f.shear", "-1", "N/m"}},
        {"[[sheet]]\n[fabric.f]\nbase = \"cotton\"\nstretch_warp = 0\n", {":4:", "fabric.f.stretch_warp", "N/m"}},
    });
}

TEST_CASE("stress curves that do not rise from the origin are refused at their point")
{
    const auto with = [](const std::string& line) {
        return "[[sheet]]\n[fabric.f]\nbase = \"cotton\"\n" + line + "\n";
    };
    check_scenes({
        {with("shear_curve = 3"), {":4:", "fabric.f.shear_curve", "points"}},
        {with("shear_curve = []"), {":4:", "fabric.f.shear_curve", "1 to 8 points"}},
        {with("shear_curve = [[0, 0]]"), {":4:", "fabric.f.shear_curve", "1 to 8 points"}},
        {with("shear_curve = [[0.1, 2],\n[0.2]]"), {":5:", "fabric.f.shear_curve", "two numbers"}},
        {with("shear_curve = [[0.1, 2],\n[0.1, 3]]"),
         {":5:", "fabric.f.shear_curve", "above those of the point before"}},
        {with("shear_curve = [[0.1, 2],\n[0.2, 1]]"),
         {":5:", "fabric.f.shear_curve", "above those of the point before"}},
        {with("shear_curve = [[0.1, nan]]"), {":4:", "fabric.f.shear_curve", "above those of the point before"}},
        {with("shear_curve = [[1.6, 2]]"), {":4:", "fabric.f.shear_curve", "1.5 rad"}},
        {with("stretch_warp_curve = [[0.1, 2], [0.5, 2.1]]"), {":4:", "fabric.f.stretch_warp_curve", "1 + strain"}},
        {with("shear = 3\nshear_curve = [[0.1, 2]]"), {":4:", "fabric.f.shear", "shear_curve"}},
        {with("curve = \"smooth\""), {":4:", "fabric.f.curve", "shear_curve"}},
        {with("curve = \"cubic\""), {":4:", "fabric.f.curve", "piecewise"}},
        {with("stretch_weft_curve = [[0.1, 1]]"), {"fabric.f.stretch_coupling", "smallest slopes"}},
    });
}

TEST_CASE("text that is no TOML is refused with its line")
{
    check_scenes({
        {"[[sheet]]\nwidth = \n", {":2:", "valid TOML"}},
        {"[[sheet]]\nwidth = 1\nwidth = 2\n", {":3:", "width", "valid TOML"}},
        {"[[sheet\n", {":1:", "valid TOML"}},
        {std::string("[[sheet]]\n\0x", 12), {"bad.toml", "valid TOML"}},
        {"[[sheet]]\nwidth = " + std::string(1000, '['), {":2:", "valid TOML"}},
        {"[[sheet]]\n[a" + many(".a", 50000) + "]\n", {":2:", "points"}},
    });
}

TEST_CASE("scenes that do not exist are refused with the nearest built-in one")
{
    check_message(message_of([] { read_scene("builtin:tshrit", {}); }), {"builtin:tshrit", "found", "`tshirt`"});
    check_message(message_of([] { read_scene("nowhere.toml", {}); }), {"nowhere.toml", "no such file", "builtin:NAME"});
    check_message(message_of([] { read_scene(std::filesystem::temp_directory_path().string(), {}); }), {"not a file"});
}

TEST_CASE("bad overrides are refused and named")
{
    check_overrides({
        {"solver.stepp=0.1", {"solver.stepp", "`step`"}},
        {"sheet.resolution=1", {"sheet[0].resolution", "1", "2 to 4097"}},
        {"garment=3", {"table.key=value"}},
        {"solver.step", {"table.key=value"}},
        {"solver.step=", {"table.key=value"}},
        {"=3", {"table.key=value"}},
        {"solver.step=[1", {"[1"}},
        {"solver.step=fast", {"solver.step", "fast", "a number"}},
        {"sheet[4].width=1", {"sheet[4]", "sheet[0]"}},
        {"solver[0].step=1", {"solver[0]", "sheet[0]"}},
        {"solvr.step=1", {"solvr", "`solver`"}},
        {"body.shape=globe", {"body[0].shape", "globe", "sphere"}},
    });
}

TEST_CASE("an override for an absent sheet is refused")
{
    const std::vector<std::string> overrides{"sheet.width=2"};
    check_message(message_of([&] { read_scene("builtin:tshirt", overrides); }), {"--set sheet.width=2", "[[sheet]]"});
}

TEST_CASE("malformed pattern files are refused with line, column or key path")
{
    check_patterns({
        {"", {":1:1:", "valid JSON"}},
        {"{\"pattern\": {\n  \"panels\" 3}}", {":2:12:", "valid JSON"}},
        {"{\"pattern\": 1,\r\"a\": {\"pattern\": \"pattern\"},\r\n\"pattern\": 2}", {":3:1:", "pattern", "twice"}},
        {"{\"pattern\": 1,, \"panels\": 2}", {":1:15:", "valid JSON"}},
        {"{\"pattern\": [,]}", {":1:14:", "valid JSON"}},
        {"{\"pattern\": 1} /* open", {"`properties`"}},
        {std::string("\xff\xfe{\0}\0", 6), {"UTF-16", "UTF-8"}},
        {pattern_with("[0, 100, 20]", "\n" + many("[", 60000) + many("]", 60000)),
         {":3:61:", "pattern.panels.front.translation", "64 deep"}},
        {pattern_with("\"rotation\"", "\"rotaton\""), {":2:10:", "pattern.panels.front", "`rotaton`", "`rotation`"}},
        {"[1]", {"[1]", "an object"}},
        {pattern_with("\"properties\"", "\"propertis\""), {"propertis", "`properties`"}},
        {pattern_with("units_in_meter", "unit_in_meters"), {"properties", "unit_in_meters", "`units_in_meter`"}},
        {pattern_with(": 100,", ": 0,"), {"properties.units_in_meter", "0"}},
        {pattern_with("\"relative\"", "\"relativ\""), {"properties.curvature_coords", "relativ", "`relative`"}},
        {pattern_with("\"stitches\"", "\"stiches\""), {"pattern", "stiches", "`stitches`"}},
        {pattern_with("\"vertices\"", "\"verts\""), {"pattern.panels.front", "`vertices`"}},
        {pattern_with("[0, 100, 20]", "[0, 100]"),
         {":2:26:", "pattern.panels.front.translation", "[0,100]", "three numbers"}},
        {pattern_with("[0, 100, 20]", "[0, 1e300, 20]"), {"pattern.panels.front.translation", "100 m"}},
        {pattern_with("[0, 0, 0]", "[0, \"x\", 0]"), {"pattern.panels.front.rotation[1]", "\"x\"", "a number"}},
    });
}

TEST_CASE("panels with impossible outlines are refused with the key path of the fault")
{
    check_patterns({
        {pattern_with("[30, 0]", "[3000, 0]"),
         {"pattern.panels.front.vertices", "30 m", "units_in_meter = 1000", "39.37 (inches) would mean 76.2002 m"}},
        {pattern_with(": 100,", ": 100000,"), {"pattern.panels.front.vertices", "0.0003 m", "units_in_meter = 100"}},
        {pattern_with("[30, 0]", "[1e999, 0]"), {":2:85:", "1e999", "valid JSON"}},
        {pattern_with("[30, 0]", "[NaN, 0]"), {":2:", "valid JSON"}},
        {pattern_with("[30, 0]", "[null, 0]"), {"pattern.panels.front.vertices[1][0]", "null", "a number"}},
        {pattern_with("{\"endpoints\": [1, 2]}", "{\"endpoints\": [1, 3]}"),
         {"pattern.panels.front.edges[1].endpoints", "[1,3]", "0 to 2"}},
        {pattern_with("{\"endpoints\": [1, 2]}", "{\"endpoints\": [1, 1.5]}"), {"edges[1].endpoints[1]", "1.5"}},
        {pattern_with("{\"endpoints\": [1, 2]}", "{\"endpoints\": [2, 1]}"), {"pattern.panels.front.edges[1]", "open"}},
        {pattern_with("{\"endpoints\": [1, 2]}", "{\"endpoint\": [1, 2]}"), {"edges[1]", "`endpoint`", "`endpoints`"}},
        {pattern_with("{\"endpoints\": [1, 2]}", "{\"endpoints\": [1, 1]}"), {"edges[1].endpoints", "length 0 m"}},
        {pattern_with("[1, 2]}", "[1, 2], \"curvature\": {\"type\": \"circel\", \"params\": [9, 0, 1]}}"),
         {"edges[1].curvature.type", "circel", "`circle`"}},
        {pattern_with("[1, 2]}", "[1, 2], \"curvature\": {\"type\": \"circle\", \"params\": [9, 0, 1]}}"),
         {"edges[1].curvature.params[0]", "9", "21.2132"}},
        {pattern_with("[1, 2]}", "[1, 2], \"curvature\": {\"type\": \"cubic\", \"params\": [[0, 1]]}}"),
         {"edges[1].curvature.params", "two control points"}},
        {pattern_with("[1, 2]}", "[1, 2], \"curvature\": [0.5, 1e9]}"), {"edges[1].curvature", "10 m"}},
        {pattern_with("[0, 30]]", "[15, 0]]"), {"pattern.panels.front.edges", "m^2"}},
        {"{\"pattern\": {\"panels\": {}, \"stitches\": []}, \"properties\": {\"units_in_meter\": 100}}",
         {"pattern.panels", "no panels"}},
    });
}

TEST_CASE("stitches that fit no panel or edge are refused")
{
    check_patterns({
        {pattern_with("{\"panel\": \"back\"", "{\"panel\": \"bakc\""),
         {":6:56:", "pattern.stitches[0][1].panel", "bakc", "`back`"}},
        {pattern_with("\"edge\": 1}", "\"edge\": 7}"), {"pattern.stitches[0][1].edge", "7", "0 to 2"}},
        {pattern_with("{\"panel\": \"back\", \"edge\": 1}", "{\"panel\": \"front\", \"edge\": 0}"),
         {"pattern.stitches[0][1]", "edge 0 of `front`", "pattern.stitches[0]"}},
        {pattern_with("\"edge\": 1}]", "\"edge\": 1}, \"wrong\"]"), {"pattern.stitches[0][2]", "wrong", "right_wrong"}},
        {pattern_with("[[{\"panel\": \"front\"", "[[{\"panl\": \"front\""), {"stitches[0][0]", "`panl`", "`panel`"}},
        {pattern_with("\"stitches\":", "\"panel_order\": [\"frnt\"], \"stitches\":"),
         {"pattern.panel_order[0]", "frnt", "`front`"}},
    });
}

TEST_CASE("bad OBJ files are refused with the line")
{
    const std::string points = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    check_objs({
        {"", {"no faces"}},
        {points, {"no faces"}},
        {"v 0 x 0\n", {":1:", "`x`", "a finite number for y"}},
        {"v 0 0\n", {":1:", "no number", "z"}},
        {points + "v nan 0 0\n", {":4:", "`nan`", "finite"}},
        {points + "v 1e400 0 0\n", {":4:", "`1e400`", "finite"}},
        {points + "f 1 2\n", {":4:", "2 vertices", "at least 3"}},
        {points + "f 1 2 4\n", {":4:", "index 4", "1 to 3"}},
        {points + "f 1 2 0\n", {":4:", "`0`", "vertex"}},
        {points + "f 1 2 -4\n", {":4:", "`-4`", "-3"}},
        {points + "f 1 2 x\n", {":4:", "`x`"}},
        {points + "f 1 2 3.5\n", {":4:", "`3.5`", "i/t/n"}},
        {points + "f 1 2 99999999999\n", {":4:", "`99999999999`"}},
        {points + "vt 0 0\nf 1/1 2/1 3/2\n", {":5:", "index 2", "texture"}},
    });
    check_message(message_of([] { read_obj("nowhere.obj", LengthUnit::m, Axis::z); }), {"nowhere.obj", "no such file"});
}
