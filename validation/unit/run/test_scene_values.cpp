#include <nlohmann/json.hpp>

#include "host/scene/scene_values.hpp"
#include "io/scene/read_scene.hpp"
#include "io/scene/scene.hpp"
#include "io/scene/scene_schema.hpp"
#include "validation/unit/catch.hpp"
#include "validation/unit/scratch_file.hpp"

using namespace selvage;

namespace {

constexpr const char* scene_text = R"(
[garment]
pattern = "builtin:vest"
[[garment.elastic]]
panel = "front"
edges = "0"
[[sheet]]
resolution = 5
fabric = "wool 1.5"
[fabric."wool 1.5"]
base = "cotton"
[[body]]
shape = "sphere"
[[body.keyframe]]
time = 1
[[pins.hold]]
panel = "sheet[0]"
group = "corners"
[[pins.motion]]
panel = "sheet[0]"
group = "corners"
velocity = [0, 0, 1]
[solver]
until = 1
)";

Scene scene_with(const std::vector<std::string>& overrides)
{
    const ScratchFolder folder;
    return read_scene(folder.write("s.toml", scene_text), overrides);
}

}  // namespace

TEST_CASE("what tells scenes apart holds every key of the schema")
{
    const std::map<std::string, std::string> values = scene_values(scene_with({}));
    const nlohmann::json schema = nlohmann::json::parse(scene_schema_json());
    for (const auto& table : schema["tables"]) {
        std::string path = table["name"];
        if (path.empty() || path == "garment.fabrics" || path == "garment.parts" || path == "fabric.NAME") continue;
        for (const char* repeated : {"sheet", "body", "keyframe", "hold", "motion", "elastic"})
            if (const std::size_t at = path.find(repeated); at != std::string::npos)
                path.insert(at + std::string(repeated).size(), "[0]");
        for (const auto& key : table["keys"]) {
            INFO(path << "." << key["name"]);
            CHECK(values.contains(path + "." + key["name"].get<std::string>()));
        }
    }
}

TEST_CASE("other held vertices are another scene")
{
    const std::map<std::string, std::string> values = scene_values(scene_with({}));
    std::map<std::string, std::string> other = values;
    other["pins.hold[0].group"] = "top_edge";
    CHECK_THAT(differing_values(values, other), contains_text("pins.hold[0].group is `corners`, was `top_edge`"));
}

TEST_CASE("a fabric whose name has a dot is dropped where the command line takes another")
{
    CHECK(scene_with({}).fabrics.contains("wool 1.5"));
    const Scene scene = scene_with({"sheet.fabric=silk"});
    CHECK(scene.sheets[0].fabric == "silk");
    CHECK(scene.text.find("wool") == std::string::npos);
}
