#include "io/scene/scene_reader.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "io/number_text.hpp"

namespace selvage {
namespace {

std::optional<double> number_of(const toml::node& node)
{
    if (const auto* integer = node.as_integer()) return double(integer->get());
    if (const auto* real = node.as_floating_point()) return real->get();
    return std::nullopt;
}

}  // namespace

TableReader::TableReader(TomlDocument& document, const toml::table* table, std::string path)
    : document_(document), table_(table), path_(std::move(path))
{
    if (table_ && !path_.empty()) document_.places[path_] = document_.place(table_->source(), path_);
}

std::string TableReader::key_path(std::string_view name) const
{
    return path_.empty() ? std::string(name) : path_ + "." + std::string(name);
}

const toml::node* TableReader::find(const char* name)
{
    known_.emplace_back(name);
    const toml::node* node = table_ ? table_->get(name) : nullptr;
    if (node) document_.places[key_path(name)] = document_.place(node->source(), key_path(name));
    return node;
}

void TableReader::refuse(const char* name, const toml::node& node, std::string_view expected,
                         std::string_view nearest) const
{
    throw InputError(document_.place(node.source(), key_path(name)), toml_value_text(node), expected, nearest);
}

void TableReader::check_range(const char* name, const toml::node& node, double value, std::string_view kind,
                              const char* unit, double low, double high) const
{
    if (value >= low && value <= high) return;
    const std::string expected = std::string(kind) + " from " + range_text(low, high, unit);
    refuse(name, node, expected, unit_slip(value, low, high, unit));
}

void TableReader::read(const char* name, double& target, const char* unit, double low, double high)
{
    const toml::node* node = find(name);
    if (!node) return;
    const std::optional<double> value = number_of(*node);
    if (!value) refuse(name, *node, "a number from " + range_text(low, high, unit));
    check_range(name, *node, *value, "a number", unit, low, high);
    target = *value;
}

void TableReader::read(const char* name, int& target, const char* unit, double low, double high)
{
    const toml::node* node = find(name);
    if (!node) return;
    const std::optional<double> value = number_of(*node);
    if (!value || *value != std::floor(*value))
        refuse(name, *node, "a whole number from " + range_text(low, high, unit));
    check_range(name, *node, *value, "a whole number", unit, low, high);
    target = int(*value);
}

void TableReader::read(const char* name, bool& target, const char*, double, double)
{
    const toml::node* node = find(name);
    if (!node) return;
    if (!node->is_boolean()) refuse(name, *node, "true or false");
    target = node->as_boolean()->get();
}

void TableReader::read(const char* name, Vec3& target, const char* unit)
{
    const toml::node* node = find(name);
    if (!node) return;
    constexpr double limit = 1e6;
    const std::string expected = "three numbers [x, y, z] from " + range_text(-limit, limit, unit);
    const toml::array* list = node->as_array();
    if (!list || list->size() != 3) refuse(name, *node, expected);
    for (int axis = 0; axis < 3; ++axis) {
        const std::optional<double> value = number_of(*list->get(std::size_t(axis)));
        if (!value || !(std::abs(*value) <= limit)) refuse(name, *node, expected);
        target[axis] = *value;
    }
}

void TableReader::read(const char* name, std::string& target)
{
    const toml::node* node = find(name);
    if (!node) return;
    const auto* text = node->as_string();
    // These are words or numbers; they are kept as text either way.
    const bool may_be_number = std::string_view(name) == "until" || std::string_view(name) == "weld";
    const std::optional<double> number = number_of(*node);
    if (!text && number && may_be_number) {
        target = number_text(*number);
        return;
    }
    if (!text) refuse(name, *node, "a text in quotes");
    // Names go into files that are read by lines, and into messages.
    if (std::ranges::any_of(text->get(), [](char c) { return (c >= 0 && c < ' ') || c == '\x7f'; }))
        refuse(name, *node, "a text of one line, without control characters");
    target = text->get();
}

std::optional<std::string> TableReader::read_word(const char* name, std::span<const std::string_view> words)
{
    const toml::node* node = find(name);
    if (!node) return std::nullopt;
    const std::vector<std::string> accepted = accepted_words(words);
    const auto* text = node->as_string();
    if (text && std::find(accepted.begin(), accepted.end(), text->get()) != accepted.end()) return text->get();
    std::string expected = "one of";
    for (const std::string& word : accepted) expected += (word == accepted.front() ? " \"" : ", \"") + word + "\"";
    refuse(name, *node, expected, text ? nearest_name(text->get(), accepted) : "");
}

void TableReader::read(const char* name, std::vector<Vec2>& target, int most, double largest_strain,
                       const char* strain_unit)
{
    const toml::node* node = find(name);
    if (!node) return;
    const toml::array* list = node->as_array();
    const std::string shape = "1 to " + std::to_string(most) + " points [[strain, stress], ...]";
    if (!list || list->empty()) refuse(name, *node, shape);
    target.clear();
    Vec2 last = Vec2::Zero();
    for (const toml::node& item : *list) {
        const toml::array* pair = item.as_array();
        const std::optional<double> strain = pair && pair->size() == 2 ? number_of(*pair->get(0)) : std::nullopt;
        const std::optional<double> stress = strain ? number_of(*pair->get(1)) : std::nullopt;
        if (!stress) refuse(name, item, "a point [strain, stress] of two numbers");
        const Vec2 point(*strain, *stress);
        if (&item == &(*list)[0] && point.isZero()) continue;
        const bool grows = point.x() > last.x() && point.y() > last.y();  // false for NaN too
        if (!grows || !(point.x() <= largest_strain) || !(point.y() <= 1e9))
            refuse(name, item,
                   "strain and stress above those of the point before, from [0, 0]; strain up to " +
                       number_text(largest_strain) + " " + strain_unit + ", stress up to 1e9 N/m");
        target.push_back(last = point);
    }
    if (target.empty() || int(target.size()) > most) refuse(name, *node, shape + " besides [0, 0]");
}

void TableReader::read(const char* name, std::vector<std::string>& target)
{
    const toml::node* node = find(name);
    if (!node) return;
    const toml::array* list = node->as_array();
    if (!list) refuse(name, *node, "a list of texts");
    for (const toml::node& item : *list) {
        if (!item.is_string()) refuse(name, item, "a list of texts");
        target.push_back(item.as_string()->get());
    }
}

const toml::table* TableReader::table(const char* name)
{
    const toml::node* node = find(name);
    if (!node) return nullptr;
    if (!node->is_table()) refuse(name, *node, "a table [" + key_path(name) + "]");
    return node->as_table();
}

std::vector<const toml::table*> TableReader::tables(const char* name)
{
    const toml::node* node = find(name);
    if (!node) return {};
    const std::string expected = "tables headed [[" + key_path(name) + "]]";
    const toml::array* list = node->as_array();
    if (!list) refuse(name, *node, expected + ", in double brackets");
    std::vector<const toml::table*> found;
    for (const toml::node& item : *list) {
        if (!item.is_table()) refuse(name, item, expected);
        found.push_back(item.as_table());
    }
    return found;
}

InputPlace TableReader::place(const std::string& name) const
{
    const auto known = document_.places.find(key_path(name));
    if (known != document_.places.end()) return known->second;
    InputPlace nearby{document_.file, 0, 0, {}};
    if (table_) nearby = document_.place(table_->source(), path_);
    nearby.key = key_path(name);
    return nearby;
}

void TableReader::refuse_unknown() const
{
    if (!table_) return;
    for (const auto& [key, node] : *table_) {
        if (std::find(known_.begin(), known_.end(), key.str()) != known_.end()) continue;
        const InputPlace place = document_.place(key.source(), key_path(key.str()));
        const std::string kind = node.is_table() || node.is_array_of_tables() ? "table" : "key";
        std::string expected = "one of the keys of " + (path_.empty() ? "a scene" : "[" + path_ + "]");
        expected += ", which `selvage schema` lists";
        throw InputError(place, "an unknown " + kind + " `" + std::string(key.str()) + "`", expected,
                         nearest_name(key.str(), known_));
    }
}

}  // namespace selvage
