#include <cmath>

#include <nlohmann/json.hpp>

#include "io/scene/fabric_table.hpp"
#include "io/scene/presets.hpp"
#include "io/scene/read_scene.hpp"
#include "io/scene/scene.hpp"
#include "io/scene/scene_schema.hpp"
#include "validation/unit/catch.hpp"
#include "validation/unit/scratch_file.hpp"

using namespace selvage;

namespace {

constexpr const char* two_sheets = R"(summary = "two sheets"

[[sheet]]
width = 2
fabric = "silk"

[[sheet]]
shape = "disc"
fabric = "own"

[[body]]
shape = "plane"

[fabric.own]
base = "cotton"
areal_density = 0.2

[solver]
until = 1.5
threads = 2.0
gravity = [0, 0, -1]

[output]
frames = false
)";

Scene read_text(const std::string& text, std::vector<std::string> overrides = {})
{
    const ScratchFolder folder;
    return read_scene(folder.write("scene.toml", text), overrides);
}

}  // namespace

TEST_CASE("a scene file's values arrive in the scene and absent ones keep their defaults")
{
    const Scene scene = read_text(two_sheets);
    CHECK(scene.name == "scene");
    CHECK(scene.summary == "two sheets");
    REQUIRE(scene.sheets.size() == 2);
    CHECK(scene.sheets[0].width == 2);
    CHECK(scene.sheets[0].height == SheetScene{}.height);
    CHECK(scene.sheets[1].shape == SheetShape::disc);
    CHECK(scene.until().time == 1.5);
    CHECK(scene.solver.threads == 2);
    CHECK(scene.solver.gravity == Vec3(0, 0, -1));
    CHECK_FALSE(scene.output.frames);
    CHECK(scene.output.picture);
    CHECK(std::isnan(scene.bodies.at(0).friction));
    CHECK_FALSE(scene.has_garment());
}

TEST_CASE("every fabric that a scene names is resolved, and properties absent from its table are those of its base")
{
    const Scene scene = read_text(two_sheets);
    REQUIRE(scene.fabrics.count("silk") == 1);
    REQUIRE(scene.fabrics.count("own") == 1);
    CHECK(scene.fabrics.at("own").areal_density == 0.2);
    CHECK(scene.fabrics.at("own").shear == fabric_preset("cotton").shear);
    CHECK(scene.fabrics.at("own").name == "own");
}

TEST_CASE("a table with a preset's name changes that preset")
{
    const Scene scene = read_scene("builtin:tshirt", std::vector<std::string>{"fabric.cotton.friction=0.9"});
    CHECK(scene.fabrics.at("cotton").friction == 0.9);
    CHECK(scene.fabrics.at("cotton").areal_density == fabric_preset("cotton").areal_density);
}

TEST_CASE("key paths are mapped to lines and columns of the file")
{
    const Scene scene = read_text(two_sheets);
    CHECK(scene.place("sheet[1].fabric").line == 9);
    CHECK(scene.place("sheet[1].fabric").column == 10);
    CHECK(scene.place("solver.until").line == 19);
    CHECK(scene.place("solver.step").line == 0);
    CHECK(scene.place("solver.step").file == scene.file);
}

TEST_CASE("overrides take TOML values and bare words and reach every sheet or the one they number")
{
    const Scene scene =
        read_text(two_sheets, {"sheet.resolution=17", "sheet[1].radius = 0.3", "solver.until=equilibrium",
                               "wind.velocity=[1, 2, 3]", "output.frames=true", "pins.sheet=corners"});
    CHECK(scene.sheets[0].resolution == 17);
    CHECK(scene.sheets[1].resolution == 17);
    CHECK(scene.sheets[0].radius == SheetScene{}.radius);
    CHECK(scene.sheets[1].radius == 0.3);
    CHECK(scene.until().equilibrium);
    CHECK(scene.wind.velocity == Vec3(1, 2, 3));
    CHECK(scene.output.frames);
    CHECK(scene.pins.sheet == PinGroup::corners);
    CHECK(scene.place("sheet[0].resolution").file == "--set sheet.resolution=17");
}

TEST_CASE("the scene's text reads back as the same scene without its overrides")
{
    const Scene first =
        read_text(two_sheets, {"solver.step=0.0123", "fabric.own.shear=12.5", "sheet.center=[0.1,0,2]"});
    const Scene second = read_text(first.text);
    CHECK(second.text == first.text);
    CHECK(second.solver.step == 0.0123);
    CHECK(second.fabrics.at("own").shear == 12.5);
    CHECK(second.sheets[1].center == Vec3(0.1, 0, 2));
    CHECK(second.summary == "two sheets");
}

TEST_CASE("single panels get their own fabric")
{
    const Scene scene = read_scene("builtin:tshirt", std::vector<std::string>{"garment.fabrics.front=denim"});
    CHECK(scene.panel_fabrics.at("front") == "denim");
    CHECK(scene.fabrics.count("denim") == 1);
    CHECK(scene.fabrics.count("cotton") == 1);
}

TEST_CASE("every built-in scene reads, has a summary and only names parameters that can be overridden")
{
    const std::vector<SceneInfo> scenes = builtin_scenes();
    REQUIRE(scenes.size() >= 6);
    for (const SceneInfo& info : scenes) {
        INFO(info.name);
        CHECK_FALSE(info.summary.empty());
        CHECK_FALSE(info.parameters.empty());
        CHECK_NOTHROW(read_scene("builtin:" + info.name, {}));
        const nlohmann::json schema = nlohmann::json::parse(scene_schema_json());
        for (const std::string& parameter : info.parameters) {
            bool known = false;
            for (const auto& table : schema["tables"])
                for (const auto& key : table["keys"]) {
                    const std::string path = table["name"].get<std::string>() + "." + key["name"].get<std::string>();
                    known = known || path == parameter;
                }
            INFO(parameter);
            CHECK(known);
        }
    }
}

TEST_CASE("the built-in sphere scene has its documented contents")
{
    const Scene scene = read_scene("builtin:sphere", {});
    const SheetScene& sheet = scene.sheets.at(0);
    const BodyScene& body = scene.bodies.at(0);
    CHECK(sheet.width == 1);
    CHECK(sheet.height == 1);
    CHECK(scene.fabrics.at(sheet.fabric).areal_density == 0.2);
    CHECK(body.radius == 0.25);
    CHECK(body.friction == 0.3);
    CHECK(sheet.center.z() - (body.center.z() + body.radius) == Approx(0.02));
    CHECK(scene.until().time == 2);
}

TEST_CASE("every built-in fabric is within the accepted ranges, has a stable membrane and names its source")
{
    const std::vector<std::string> names = fabric_preset_names();
    REQUIRE(names.size() >= 8);
    for (const std::string& name : names) {
        const Fabric fabric = fabric_preset(name);
        INFO(name);
        CHECK(fabric.name == name);
        CHECK_FALSE(fabric.source.empty());
        CHECK_NOTHROW(check_fabric(fabric, "", name));
        const double bending_length = std::cbrt(fabric.bending_warp / (fabric.areal_density * 9.81));
        CHECK(bending_length > 0.008);
        CHECK(bending_length < 0.05);
    }
}

TEST_CASE("a narrow strip of the cotton preset shows the measured stiffness of 261 N/m")
{
    const Fabric cotton = fabric_preset("cotton");
    const double strip = cotton.stretch_weft - cotton.stretch_coupling * cotton.stretch_coupling / cotton.stretch_warp;
    CHECK(strip == Approx(261.1).epsilon(0.002));
}

TEST_CASE("the schema lists every key with the default that the scene's structs have")
{
    const nlohmann::json schema = nlohmann::json::parse(scene_schema_json());
    const std::string text = scene_schema_text();
    int checked = 0;
    for (const auto& table : schema["tables"])
        for (const auto& key : table["keys"]) {
            INFO(table["name"] << "." << key["name"]);
            CHECK(text.find("\n  " + key["name"].get<std::string>()) != std::string::npos);
            CHECK_FALSE(key["meaning"].get<std::string>().empty());
            if (table["name"] == "solver" && key["name"] == "step") {
                CHECK(key["default"] == SolverScene{}.step);
                CHECK(key["unit"] == "s");
                ++checked;
            }
            if (table["name"] == "body" && key["name"] == "friction") {
                CHECK(key["default"].is_null());
                ++checked;
            }
        }
    CHECK(checked == 2);
}

TEST_CASE("built-in files are found by folder and name")
{
    REQUIRE(find_preset("fabrics", "cotton"));
    CHECK(find_preset("fabrics", "cotton")->text.find("areal_density") != std::string_view::npos);
    CHECK_FALSE(find_preset("fabrics", "tshirt"));
    CHECK(preset_names("scenes").size() == builtin_scenes().size());
}
