#include <algorithm>
#include <cmath>
#include <string_view>
#include <type_traits>

#include <nlohmann/json.hpp>

#include "io/number_text.hpp"
#include "io/scene/fabric_table.hpp"
#include "io/scene/scene.hpp"
#include "io/scene/scene_schema.hpp"

namespace selvage {
namespace {

using Json = nlohmann::ordered_json;

struct KeyText {
    std::string name, type, initial, unit, range, meaning;
    Json json;
};

struct TableText {
    std::string heading, name, meaning;
    bool repeated = false;
    std::vector<KeyText> keys;
};

std::string joined(const std::vector<std::string>& words, const char* between)
{
    std::string text;
    for (const std::string& word : words) text += (text.empty() ? "" : between) + word;
    return text;
}

template <class T>
KeyText number_key(const char* name, T initial, const char* unit, double low, double high, const char* meaning)
{
    KeyText key{name, "", "", unit, range_text(low, high, "1"), meaning, {}};
    Json value = initial;
    if constexpr (std::is_same_v<T, bool>) {
        key.type = "flag";
        key.initial = initial ? "true" : "false";
        key.range = "true or false";
    } else {
        const bool given = !std::isnan(double(initial));
        key.type = std::is_same_v<T, int> ? "whole number" : "number";
        key.initial = given ? number_text(double(initial)) : "automatic";
        if (!given) value = nullptr;
    }
    key.json = {{"name", name}, {"type", key.type}, {"default", value}, {"unit", unit}, {"meaning", meaning}};
    if (key.type != "flag") key.json.update({{"low", low}, {"high", high}});
    return key;
}

KeyText text_key(const char* name, const char* initial, const char* meaning)
{
    KeyText key{name, "text", '"' + std::string(initial) + '"', "", "any text", meaning, {}};
    key.json = {{"name", name}, {"type", key.type}, {"default", initial}, {"meaning", meaning}};
    return key;
}

KeyText choice_key(const char* name, WordEnum auto initial, const char* meaning)
{
    KeyText key = text_key(name, text_of(initial).c_str(), meaning);
    const std::vector<std::string> words = accepted_words(words_of<decltype(initial)>());
    key.type = key.json["type"] = "word";
    key.range = joined(words, " ");
    key.json["choices"] = words;
    return key;
}

KeyText vector_key(const char* name, double x, double y, double z, const char* unit, const char* meaning)
{
    KeyText key{name, "three numbers", "", unit, "three numbers", meaning, {}};
    key.initial = "[" + number_text(x) + ", " + number_text(y) + ", " + number_text(z) + "]";
    key.json = {{"name", name}, {"type", key.type}, {"default", {x, y, z}}, {"unit", unit}, {"meaning", meaning}};
    return key;
}

KeyText curve_key(const char* name, const char* meaning)
{
    KeyText key{name, "points", "none", "1, N/m", "[[strain, stress], ...]", meaning, {}};
    key.json = {{"name", name}, {"type", key.type}, {"default", nullptr}, {"unit", key.unit}, {"meaning", meaning}};
    return key;
}

#define LIST_KEY(type, name, initial, unit, low, high, meaning) \
    number_key<type>(#name, initial, unit, low, high, meaning),
#define LIST_WORD(name, initial, meaning) text_key(#name, initial, meaning),
#define LIST_CHOICE(name, type, initial, meaning) choice_key(#name, type::initial, meaning),
#define LIST_CURVE(name, number, measure, meaning) curve_key(#name, meaning),
#define LIST_VEC3(name, x, y, z, unit, meaning) vector_key(#name, x, y, z, unit, meaning),
std::vector<TableText> tables()
{
    const std::vector<KeyText> top{text_key("summary", "", "what the scene shows, in one sentence"),
                                   KeyText{"parameters",
                                           "list of texts",
                                           "[]",
                                           "",
                                           "any texts",
                                           "keys that are commonly overridden",
                                           {{"name", "parameters"},
                                            {"type", "list of texts"},
                                            {"default", Json::array()},
                                            {"meaning", "keys that are commonly overridden"}}}};
    std::vector<TableText> list{{"(top of the file)", "", "the scene itself", false, top}};
#define SCENE_TABLE(name, type, keys, meaning) \
    list.push_back({"[" #name "]", #name, meaning, false, {keys(LIST_KEY, LIST_WORD, LIST_CHOICE, LIST_VEC3)}});
    SCENE_TABLES(SCENE_TABLE)
#undef SCENE_TABLE
    list.push_back(
        {"[garment.fabrics]", "garment.fabrics", "fabrics of single panels, as PANEL = \"FABRIC\"", false, {}});
#define REPEATED_TABLE(path, type, keys, meaning) \
    list.push_back({"[[" path "]]", path, meaning, true, {keys(LIST_KEY, LIST_WORD, LIST_CHOICE, LIST_VEC3)}});
    REPEATED_TABLES(REPEATED_TABLE)
#undef REPEATED_TABLE
    list.push_back({"[fabric.NAME]",
                    "fabric.NAME",
                    "a fabric of the scene's own, or changes to a built-in one",
                    false,
                    {FABRIC_KEYS(LIST_KEY, LIST_WORD, LIST_CHOICE, LIST_CURVE)}});
    return list;
}
#undef LIST_KEY
#undef LIST_WORD
#undef LIST_CHOICE
#undef LIST_VEC3
#undef LIST_CURVE

void append_column(std::string& line, const std::string& text, std::size_t width)
{
    line += text + std::string(width - std::min(width, text.size()) + 2, ' ');
}

}  // namespace

std::string scene_schema_text()
{
    const std::vector<TableText> list = tables();
    std::size_t name = 0, initial = 0, unit = 0, range = 0;
    for (const TableText& table : list)
        for (const KeyText& key : table.keys) {
            name = std::max(name, key.name.size());
            initial = std::max(initial, key.initial.size());
            unit = std::max(unit, key.unit.size());
            range = std::max(range, std::min<std::size_t>(key.range.size(), 24));
        }
    std::string text =
        "Scene keys: name, default, unit (1: a pure number), accepted values, meaning. SI units, z up.\n";
    for (const TableText& table : list) {
        text += "\n" + table.heading + "  " + table.meaning + "\n";
        for (const KeyText& key : table.keys) {
            std::string line = "  ";
            append_column(line, key.name, name);
            append_column(line, key.initial, initial);
            append_column(line, key.unit, unit);
            append_column(line, key.range, range);
            text += line + key.meaning + "\n";
        }
    }
    return text + "\nBuilt-in fabrics: " + joined(fabric_preset_names(), ", ") + "\n";
}

std::string scene_schema_json()
{
    Json schema = {{"tables", Json::array()}, {"fabrics", fabric_preset_names()}};
    for (const TableText& table : tables()) {
        Json keys = Json::array();
        for (const KeyText& key : table.keys) keys.push_back(key.json);
        schema["tables"].push_back(
            {{"name", table.name}, {"meaning", table.meaning}, {"repeated", table.repeated}, {"keys", keys}});
    }
    return schema.dump(2);
}

}  // namespace selvage
