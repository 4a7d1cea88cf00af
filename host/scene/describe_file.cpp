#include "host/scene/describe_file.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include <Eigen/Geometry>
#include <nlohmann/json.hpp>

#include "io/errors.hpp"
#include "io/file_text.hpp"
#include "io/mesh/mesh_obj.hpp"
#include "io/number_text.hpp"
#include "io/pattern/pattern_json.hpp"
#include "io/run/describe.hpp"
#include "io/scene/fabric_table.hpp"
#include "io/scene/presets.hpp"
#include "io/scene/read_scene.hpp"
#include "io/utf8.hpp"

namespace selvage {
namespace {

using Json = nlohmann::ordered_json;

Json size_of(const std::vector<Vec3>& points)
{
    Eigen::AlignedBox3d box;
    for (const Vec3& point : points) box.extend(point);
    const Vec3 size = box.sizes();
    return {size.x(), size.y(), size.z()};
}

Json describe_mesh(const std::string& path)
{
    const ObjMesh mesh = read_obj(path, LengthUnit::m, Axis::z);
    Json json{{"file", path}, {"kind", "mesh"}};
    json["vertices"] = mesh.vertices.size();
    // A polygon of n corners becomes n - 2 triangles.
    json["triangles"] = int(mesh.corner_vertices.size()) - 2 * mesh.polygon_count();
    json["size"] = size_of(mesh.vertices);
    json["objects"] = Json::array();
    for (const MeshPart& part : mesh.parts) json["objects"].push_back(part.name);
    return json;
}

Json describe_pattern(const std::string& path)
{
    const Pattern pattern = read_pattern_json(path, {});
    Json json{{"file", path}, {"kind", "pattern"}, {"panels", Json::array()}};
    for (const PatternPanel& panel : pattern.panels) {
        Vec2 low = panel.vertices.front(), high = low;
        for (const Vec2& corner : panel.vertices) {
            low = low.cwiseMin(corner);
            high = high.cwiseMax(corner);
        }
        const Vec2 size = high - low;
        json["panels"].push_back(
            {{"name", panel.name}, {"edges", panel.edges.size()}, {"size_m", {size.x(), size.y()}}});
    }
    json["stitches"] = pattern.stitches.size();
    return json;
}

Json describe_scene(const std::string& source)
{
    const Scene scene = read_scene(source, {});
    Json json{{"file", source}, {"kind", "scene"}, {"name", scene.name}, {"summary", scene.summary}};
    if (scene.has_garment()) json["garment"] = scene.garment.pattern;
    json["sheets"] = Json::array();
    for (const SheetScene& sheet : scene.sheets) json["sheets"].push_back(text_of(sheet.shape));
    json["bodies"] = Json::array();
    for (const BodyScene& body : scene.bodies) json["bodies"].push_back(text_of(body.shape));
    json["fabrics"] = Json::array();
    for (const auto& [name, fabric] : scene.fabrics) json["fabrics"].push_back(name);
    json["until"] = scene.solver.until;
    return json;
}

Json describe_fabrics(const std::string& source, const std::vector<Fabric>& fabrics)
{
    Json json{{"file", source}, {"kind", "fabrics"}, {"fabrics", Json::array()}};
    for (const Fabric& fabric : fabrics) {
        Json entry{{"name", fabric.name}};
#define TELL(type, name, initial, unit, low, high, meaning) entry[#name] = fabric.name;
#define NOT_TOLD(name, ...)
        FABRIC_KEYS(TELL, NOT_TOLD, NOT_TOLD, NOT_TOLD)
#undef TELL
#undef NOT_TOLD
        entry["source"] = fabric.source;
        json["fabrics"].push_back(entry);
    }
    return json;
}

// A value on one line: lists with commas, the members of an object as `name value`.
std::string plain(const Json& value)
{
    if (value.is_string()) return printable(value.get<std::string>());
    if (value.is_null() || (value.is_number() && !std::isfinite(value.get<double>()))) return "automatic";
    if (value.is_number_float()) return rounded_text(value);
    if (!value.is_structured()) return value.dump();
    std::string text;
    for (const auto& [key, part] : value.items())
        text += (text.empty() ? "" : ", ") + (value.is_object() ? key + " " : std::string()) + plain(part);
    return text.empty() ? "none" : text;
}

std::string lines(const Json& held)
{
    std::string text = plain(held["file"]) + ": " + held["kind"].get<std::string>() + "\n";
    for (const auto& [key, value] : held.items()) {
        if (key == "file" || key == "kind") continue;
        const bool of_objects = value.is_array() && !value.empty() && value.front().is_object();
        text += key + std::string(std::max<std::size_t>(1, 11 - std::min<std::size_t>(10, key.size())), ' ');
        if (!of_objects) text += plain(value);
        text += '\n';
        for (std::size_t k = 0; of_objects && k < value.size(); ++k) text += "    " + plain(value[k]) + '\n';
    }
    return text;
}

bool is_hdf5(const std::string& text) { return text.starts_with("\x89HDF\r\n\x1a\n"); }

Json describe_text_file(const std::string& path)
{
    const std::string ending = std::filesystem::path(path).extension().string();
    if (ending == ".obj" || ending == ".OBJ") return describe_mesh(path);
    const std::string text = read_file_text(path, "a run, a mesh, a pattern, a scene or fabrics");
    const std::size_t first = text.find_first_not_of(" \t\r\n\xef\xbb\xbf");
    if (ending == ".json" || (first != std::string::npos && text[first] == '{')) return describe_pattern(path);
    const std::vector<Fabric> fabrics = read_fabrics(text, path);
    return fabrics.empty() ? describe_scene(path) : describe_fabrics(path, fabrics);
}

}  // namespace

std::string describe_file(const std::string& source, bool json)
{
    std::error_code error;
    const bool present = std::filesystem::exists(source, error);
    const std::vector<std::string> fabrics = fabric_preset_names();
    const bool is_fabric = !present && std::find(fabrics.begin(), fabrics.end(), source) != fabrics.end();
    if (present && is_hdf5(read_file_start(source, "a run, a mesh, a pattern, a scene or fabrics", 8)))
        return describe_run(source, json);
    const Json held = is_fabric            ? describe_fabrics(source, {fabric_preset(source)})
                      : is_builtin(source) ? describe_scene(source)
                                           : describe_text_file(source);
    return json ? held.dump(2, ' ', false, Json::error_handler_t::replace) + "\n" : lines(held);
}

}  // namespace selvage
