#include "host/scene/scene_values.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "io/content_hash.hpp"
#include "io/file_text.hpp"
#include "io/mesh/mesh_obj.hpp"
#include "io/number_text.hpp"
#include "io/scene/presets.hpp"

namespace selvage {
namespace {

using Values = std::map<std::string, std::string>;

// What may change where a run is resumed: a key, or a table with a dot at its end.
constexpr std::string_view changeable[] = {"solver.until",   "solver.max_time",     "solver.max_wall",
                                           "solver.threads", "solver.memory_limit", "seams.max_time",
                                           "output."};

std::string text(double value) { return std::isnan(value) ? "automatic" : number_text(value); }
std::string text(int value) { return std::to_string(value); }
std::string text(bool value) { return value ? "true" : "false"; }
std::string text(const std::string& value) { return value; }
std::string text(const Vec3& x) { return fmt::format("[{}, {}, {}]", text(x.x()), text(x.y()), text(x.z())); }
std::string text(const StressCurve& curve)
{
    std::string all;
    for (const CurveRange& range : curve)
        for (double number : {range.start, range.stress, range.slope, range.quadratic, range.cubic})
            all += (all.empty() ? "" : " ") + text(number);
    return all;
}

// Writes the keys of one table.
struct Table {
    const Scene& scene;
    std::string path;
    Values& to;

    template <class Value>
    void put(const char* key, const Value& value) const
    {
        if constexpr (WordEnum<Value>)
            to[path + key] = word_of(value);
        else
            to[path + key] = text(value);
    }

    // A key whose word may be the name of a file, or of several with a *.
    void put_file(const char* key, const std::string& name) const
    {
        if (name.empty() || is_builtin(name)) return;
        const std::string file = scene.resolve(name);
        std::vector<std::string> files{file};
        if (file.find('*') != std::string::npos) {
            files.clear();
            for (SequenceFile& one : sequence_files(file, scene.place(path + key)))
                files.push_back(std::move(one.path));
        }
        ContentHash hash;
        for (const std::string& one : files) {
            std::error_code error;
            if (!std::filesystem::is_regular_file(one, error)) return;  // the reader of the model says what is wrong
            hash.add(read_file_text(one, "a file of the scene"));
        }
        to[path + key + ".contents"] = hash.text();
    }
};

#define PUT_KEY(type, name, initial, unit, low, high, meaning) table.put(#name, from.name);
#define PUT_WORD(name, initial, meaning) table.put(#name, from.name);
#define PUT_CHOICE(name, type, initial, meaning) table.put(#name, from.name);
#define PUT_VEC3(name, x, y, z, unit, meaning) table.put(#name, from.name);
#define SCENE_TABLE(name, type, keys, meaning) \
    void put_keys(const Table& table, const type& from) { keys(PUT_KEY, PUT_WORD, PUT_CHOICE, PUT_VEC3) }
SCENE_TABLES(SCENE_TABLE)
REPEATED_TABLES(SCENE_TABLE)
#undef SCENE_TABLE
#undef PUT_KEY
#undef PUT_WORD
#undef PUT_CHOICE
#undef PUT_VEC3

// A fabric as it is used: where it was taken from does not matter.
#define PUT_KEY(type, name, initial, unit, low, high, meaning) table.put(#name, from.name);
#define PUT_CURVE(name, number, measure, meaning) table.put(#name, from.name);
#define SKIP(...)
void put_fabric(const Table& table, const Fabric& from) { FABRIC_KEYS(PUT_KEY, SKIP, SKIP, PUT_CURVE) }
#undef PUT_KEY
#undef PUT_CURVE
#undef SKIP

void put_bodies(const Scene& scene, Values& values)
{
    for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
        const BodyScene& body = scene.bodies[b];
        const Table table{scene, fmt::format("body[{}].", b), values};
        put_keys(table, body);
        table.put_file("mesh", body.mesh);
        table.put_file("sequence", body.sequence);
        for (std::size_t k = 0; k < body.keyframes.size(); ++k) {
            const Table keyframe{scene, fmt::format("{}keyframe[{}].", table.path, k), values};
            put_keys(keyframe, body.keyframes[k]);
            keyframe.put_file("mesh", body.keyframes[k].mesh);
        }
    }
}

}  // namespace

std::map<std::string, std::string> scene_values(const Scene& scene)
{
    Values values;
#define SCENE_TABLE(name, type, keys, meaning) put_keys({scene, #name ".", values}, scene.name);
    SCENE_TABLES(SCENE_TABLE)
#undef SCENE_TABLE
    const Table garment{scene, "garment.", values};
    garment.put_file("pattern", scene.garment.pattern);
    for (const auto& [panel, fabric] : scene.panel_fabrics) values["garment.fabrics." + panel] = fabric;
    for (const auto& [panel, part] : scene.panel_parts) values["garment.parts." + panel] = part;
    for (std::size_t e = 0; e < scene.elastics.size(); ++e)
        put_keys({scene, fmt::format("garment.elastic[{}].", e), values}, scene.elastics[e]);
    for (std::size_t s = 0; s < scene.sheets.size(); ++s) {
        const Table table{scene, fmt::format("sheet[{}].", s), values};
        put_keys(table, scene.sheets[s]);
        table.put_file("mesh", scene.sheets[s].mesh);
    }
    put_bodies(scene, values);
    for (std::size_t h = 0; h < scene.pin_holds.size(); ++h)
        put_keys({scene, fmt::format("pins.hold[{}].", h), values}, scene.pin_holds[h]);
    for (std::size_t m = 0; m < scene.pin_motions.size(); ++m)
        put_keys({scene, fmt::format("pins.motion[{}].", m), values}, scene.pin_motions[m]);
    for (const auto& [name, fabric] : scene.fabrics) put_fabric({scene, "fabric." + name + ".", values}, fabric);
    return values;
}

bool may_change_on_resume(std::string_view key)
{
    return std::any_of(std::begin(changeable), std::end(changeable), [&](std::string_view free) {
        return free.ends_with('.') ? key.starts_with(free) : key == free;
    });
}

std::string differing_values(const std::map<std::string, std::string>& now,
                             const std::map<std::string, std::string>& before)
{
    std::vector<std::string> differing;
    for (const auto& [key, value] : now)
        if (const auto at = before.find(key); at != before.end() && at->second != value && !may_change_on_resume(key))
            differing.push_back(fmt::format("{} is `{}`, was `{}`", key, value, at->second));
    // Of tables that only one of them has, one line says it.
    const auto note_missing = [&](const Values& of, const Values& in, const char* what) {
        for (const auto& [key, value] : of) {
            if (in.contains(key) || may_change_on_resume(key)) continue;
            const std::string line = key.substr(0, key.rfind('.')) + what;
            if (std::find(differing.begin(), differing.end(), line) == differing.end()) differing.push_back(line);
        }
    };
    note_missing(now, before, " has keys that were not there");
    note_missing(before, now, " had keys that are not there");
    constexpr std::size_t most = 5;  // told one by one
    std::string told = fmt::format(
        "{}", fmt::join(differing.begin(), differing.begin() + std::ptrdiff_t(std::min(most, differing.size())), "; "));
    if (differing.size() > most) told += fmt::format("; and {} more", differing.size() - most);
    return told;
}

}  // namespace selvage
