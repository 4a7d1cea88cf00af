#include "io/scene/read_scene.hpp"

#include <algorithm>
#include <filesystem>
#include <sstream>

#include "io/file_text.hpp"
#include "io/scene/fabric_table.hpp"
#include "io/scene/key_rules.hpp"
#include "io/scene/presets.hpp"
#include "io/scene/scene_checks.hpp"
#include "io/scene/scene_reader.hpp"
#include "io/utf8.hpp"

namespace selvage {
namespace {

namespace fs = std::filesystem;

constexpr const char* scene_folder = "scenes";

TomlDocument read_document(const std::string& source)
{
    if (!is_builtin(source)) return parse_toml(read_file_text(source, "a scene file (TOML) or builtin:NAME"), source);
    const std::string name = source.substr(builtin_prefix.size());
    if (const PresetFile* file = find_preset(scene_folder, name)) return parse_toml(file->text, source);
    throw InputError({source, 0, 0, {}}, "`" + name + "`", "a built-in scene, which `selvage scenes` lists",
                     nearest_name(name, preset_names(scene_folder)));
}

#define READ_KEY(type, name, initial, unit, low, high, meaning) reader.read(#name, target.name, unit, low, high);
#define READ_WORD(name, initial, meaning) reader.read(#name, target.name);
#define READ_CHOICE(name, type, initial, meaning) reader.read(#name, target.name);
#define READ_VEC3(name, x, y, z, unit, meaning) reader.read(#name, target.name, unit);
#define SCENE_TABLE(name, type, keys, meaning) \
    void read_keys(TableReader& reader, type& target) { keys(READ_KEY, READ_WORD, READ_CHOICE, READ_VEC3) }
SCENE_TABLES(SCENE_TABLE)
REPEATED_TABLES(SCENE_TABLE)
#undef SCENE_TABLE
#undef READ_KEY
#undef READ_WORD
#undef READ_CHOICE
#undef READ_VEC3

// Tables [[outer.name]] of a table that may itself be repeated.
template <class Table>
void read_repeated(TomlDocument& document, TableReader& outer, const char* name, std::vector<Table>& targets)
{
    for (const toml::table* table : outer.tables(name)) {
        TableReader reader(document, table, outer.path() + "." + name + "[" + std::to_string(targets.size()) + "]");
        read_keys(reader, targets.emplace_back());
        reader.refuse_unknown();
    }
}

// A table whose keys are the pattern's panels, which are not known here.
void read_panel_words(TomlDocument& document, TableReader& garment, const char* name,
                      std::map<std::string, std::string>& words)
{
    const toml::table* table = garment.table(name);
    if (!table) return;
    TableReader inner(document, table, std::string("garment.") + name);
    for (const auto& [panel, node] : *table)
        inner.read(std::string(panel.str()).c_str(), words[std::string(panel.str())]);
}

void read_inner_tables(TomlDocument& document, TableReader& reader, GarmentScene&, Scene& scene)
{
    read_repeated(document, reader, "elastic", scene.elastics);
    read_panel_words(document, reader, "fabrics", scene.panel_fabrics);
    read_panel_words(document, reader, "parts", scene.panel_parts);
}

void read_inner_tables(TomlDocument& document, TableReader& reader, PinsScene&, Scene& scene)
{
    read_repeated(document, reader, "hold", scene.pin_holds);
    read_repeated(document, reader, "motion", scene.pin_motions);
}

void read_inner_tables(TomlDocument& document, TableReader& reader, BodyScene& body, Scene&)
{
    read_repeated(document, reader, "keyframe", body.keyframes);
}

template <class Table>
void read_inner_tables(TomlDocument&, TableReader&, Table&, Scene&)
{
}

template <class Table>
void read_table(TomlDocument& document, TableReader& top, const char* name, Table& target, Scene& scene)
{
    TableReader reader(document, top.table(name), name);
    read_keys(reader, target);
    read_inner_tables(document, reader, target, scene);
    reader.refuse_unknown();
}

template <class Table>
void read_tables(TomlDocument& document, TableReader& top, const char* name, std::vector<Table>& targets, Scene& scene)
{
    for (const toml::table* table : top.tables(name)) {
        TableReader reader(document, table, std::string(name) + "[" + std::to_string(targets.size()) + "]");
        read_keys(reader, targets.emplace_back());
        read_inner_tables(document, reader, targets.back(), scene);
        reader.refuse_unknown();
    }
}

void read_fabrics(TomlDocument& document, TableReader& top, Scene& scene)
{
    const toml::table* fabrics = top.table("fabric");
    if (!fabrics) return;
    TableReader reader(document, fabrics, "fabric");
    for (const auto& [key, node] : *fabrics) {
        const std::string name(key.str());
        TableReader fabric(document, reader.table(name.c_str()), "fabric." + name);
        scene.fabrics[name] = read_fabric_table(fabric, name);
    }
}

std::vector<std::string> read_top_keys(TableReader& top, std::string& summary)
{
    std::vector<std::string> parameters;
    top.read("summary", summary);
    top.read("parameters", parameters);
    return parameters;
}

Scene scene_of(TomlDocument document, const std::string& source)
{
    Scene scene;
    scene.file = source;
    scene.name =
        valid_utf8(is_builtin(source) ? source.substr(builtin_prefix.size()) : fs::path(source).stem().string());
    scene.folder = is_builtin(source) ? std::string() : fs::path(source).parent_path().string();
    TableReader top(document, &document.root, "");
    scene.parameters = read_top_keys(top, scene.summary);
#define SCENE_TABLE(name, type, keys, meaning) read_table(document, top, #name, scene.name, scene);
    SCENE_TABLES(SCENE_TABLE)
#undef SCENE_TABLE
    read_tables(document, top, "sheet", scene.sheets, scene);
    read_tables(document, top, "body", scene.bodies, scene);
    read_fabrics(document, top, scene);
    top.refuse_unknown();
    scene.places = std::move(document.places);

    check_scene(scene);
    resolve_fabrics(scene);
    if (const std::vector<std::string> overruled = overruled_keys(scene); !overruled.empty()) {
        for (const std::string& key : overruled) remove_key(document.root, key);
        document.places.clear();
        return scene_of(std::move(document), source);
    }
    std::ostringstream text;
    text << document.root << '\n';
    scene.text = text.str();
    return scene;
}

}  // namespace

Scene read_scene(const std::string& source, std::span<const std::string> overrides)
{
    TomlDocument document = read_document(source);
    for (const std::string& text : overrides) apply_override(document, text);
    return scene_of(std::move(document), source);
}

Scene read_scene_text(const std::string& text, const std::string& source)
{
    return scene_of(parse_toml(text, source), source);
}

std::vector<SceneInfo> builtin_scenes()
{
    std::vector<SceneInfo> scenes;
    for (const std::string& name : preset_names(scene_folder)) {
        TomlDocument document = read_document(std::string(builtin_prefix) + name);
        TableReader top(document, &document.root, "");
        SceneInfo& info = scenes.emplace_back();
        info.name = name;
        info.parameters = read_top_keys(top, info.summary);
    }
    return scenes;
}

}  // namespace selvage
