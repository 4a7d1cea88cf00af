#include <algorithm>
#include <cctype>
#include <charconv>
#include <sstream>
#include <stdexcept>

#include "io/number_text.hpp"
#include "io/scene/scene_reader.hpp"

namespace selvage {
namespace {

bool is_inside(std::string_view path, std::string_view outer)
{
    return path.substr(0, outer.size()) == outer &&
           (path.size() == outer.size() || path[outer.size()] == '.' || path[outer.size()] == '[');
}

std::string joined(const std::string& path, std::string_view name)
{
    return path.empty() ? std::string(name) : path + "." + std::string(name);
}

[[noreturn]] void refuse_override(const std::string& text, std::string_view found, std::string_view expected)
{
    throw InputError({"--set " + text, 0, 0, {}}, found, expected);
}

// Copies drop the line numbers of the override's own text, so that its values cannot pass for lines of the file.
void merge(TomlDocument& document, toml::table& target, const toml::table& changes, const std::string& path,
           const std::string& text)
{
    for (const auto& [key, change] : changes) {
        const std::string key_path = joined(path, key.str());
        if (change.is_table() && !target.contains(key.str())) {
            target.insert(key.str(), toml::table{});
            document.overrides[key_path] = text;
        }
        toml::node* old = target.get(key.str());
        if (change.is_table() && old->is_table()) {
            merge(document, *old->as_table(), *change.as_table(), key_path, text);
        } else {
            change.visit([&](const auto& node) { target.insert_or_assign(key.str(), node); });
            document.overrides[key_path] = text;
        }
    }
}

// Parses `key = value`, taking a value that is no TOML as a bare word.
toml::table parse_assignment(const std::string& text)
{
    const std::size_t equals = text.find('=');
    const std::string_view spaces = " \t";
    if (equals == std::string::npos || text.find_first_not_of(spaces) == equals ||
        text.find_first_not_of(spaces, equals + 1) == std::string::npos || text.find('\n') != std::string::npos)
        refuse_override(text, "`" + text + "`", "table.key=value");
    try {
        return toml::parse(text);
    } catch (const toml::parse_error&) {
    }
    std::string word = text.substr(text.find_first_not_of(spaces, equals + 1));
    const bool quotable = word.find('\'') == std::string::npos && std::string_view("\"[{").find(word[0]) > 2;
    try {
        if (quotable) return toml::parse(text.substr(0, equals) + "= '" + word + "'");
    } catch (const toml::parse_error&) {
    }
    refuse_override(text, "`" + word + "`", "table.key=value with a TOML value or a bare word");
}

// Takes `[2]` out of `sheet[2].key=...`; -1: every element.
int take_element_index(std::string& text, const std::string& original)
{
    const std::size_t open = text.find('['), close = text.find(']'), equals = text.find('=');
    if (open == std::string::npos || open > equals) return -1;
    int index = -1;
    if (close < equals) {
        const char* end = text.data() + close;
        const std::from_chars_result parsed = std::from_chars(text.data() + open + 1, end, index);
        if (parsed.ec != std::errc() || parsed.ptr != end) index = -1;
    }
    const std::string name = text.substr(0, open);
    if (index < 0 || (name != "sheet" && name != "body"))
        refuse_override(original, "`" + name + text.substr(open, close - open + 1) + "`",
                        "an element such as sheet[0] or body[1]");
    text.erase(open, close - open + 1);
    return index;
}

void merge_elements(TomlDocument& document, const std::string& name, const toml::table& changes, int index,
                    const std::string& text)
{
    toml::node* node = document.root.get(name);
    toml::array* elements = node ? node->as_array() : nullptr;
    const int count = elements ? int(elements->size()) : 0;
    if (count == 0) refuse_override(text, "a scene without [[" + name + "]]", "a scene that has one");
    if (index >= count)
        refuse_override(text, name + "[" + std::to_string(index) + "]",
                        name + "[0] to " + name + "[" + std::to_string(count - 1) + "]");
    for (int element = 0; element < count; ++element) {
        toml::table* table = (*elements)[std::size_t(element)].as_table();
        if ((index >= 0 && index != element) || !table) continue;
        merge(document, *table, changes, name + "[" + std::to_string(element) + "]", text);
    }
}

// Tables within tables are read and freed by recursion, so a key of very many parts would exhaust the stack.
void refuse_deep_keys(std::string_view text, const std::string& file)
{
    constexpr int limit = 100;
    int line = 1, dots = 0;
    for (const char c : text) {
        line += c == '\n';
        if (c == '.')
            ++dots;
        else if (std::string_view(",=[]{}\n").find(c) != std::string_view::npos)
            dots = 0;
        if (dots > limit)
            throw InputError({file, line, 0, {}}, "more than " + std::to_string(limit) + " points in a row",
                             "keys of a few parts");
    }
}

// TOML knows LF and CR LF; old editors end lines with CR alone.
std::string with_line_feeds(std::string_view text)
{
    std::string result(text);
    for (std::size_t at = 0; at < result.size(); ++at)
        if (result[at] == '\r' && (at + 1 == result.size() || result[at + 1] != '\n')) result[at] = '\n';
    return result;
}

}  // namespace

InputPlace TomlDocument::place(const toml::source_region& region, const std::string& key) const
{
    if (region.begin.line > 0) return {file, int(region.begin.line), int(region.begin.column), key};
    const std::string* found = nullptr;
    for (const auto& [path, text] : overrides)
        if (is_inside(key, path)) found = &text;
    return {found ? "--set " + *found : file, 0, 0, key};
}

TomlDocument parse_toml(std::string_view file_text, const std::string& file)
{
    const std::string text = with_line_feeds(file_text);
    TomlDocument document;
    document.file = file;
    refuse_deep_keys(text, file);
    try {
        document.root = toml::parse(std::string_view(text), std::string_view(file));
    } catch (const toml::parse_error& error) {
        const toml::source_position begin = error.source().begin;
        std::string found(error.description());
        found[0] = char(std::tolower(found[0]));
        throw InputError({file, int(begin.line), int(begin.column), {}}, found, "valid TOML");
    }
    return document;
}

void apply_override(TomlDocument& document, const std::string& override_text)
{
    std::string text = override_text;
    const int index = take_element_index(text, override_text);
    refuse_deep_keys(text, "--set " + override_text);
    const toml::table assignment = parse_assignment(text);
    const auto first = assignment.begin();
    const std::string name(first->first.str());
    if (assignment.size() != 1 || !first->second.is_table())
        refuse_override(override_text, "`" + name + "`", "table.key=value");
    if (name == "sheet" || name == "body")
        merge_elements(document, name, *first->second.as_table(), index, override_text);
    else
        merge(document, document.root, assignment, "", override_text);
}

namespace {

// Names may hold dots themselves, as that of a fabric "wool 1.5": each name of a table is tried at the front of the
// path.
bool erase(toml::table& table, std::string_view path)
{
    for (auto&& [key, node] : table) {
        if (path == key.str()) {
            table.erase(key);
            return true;
        }
        if (!path.starts_with(key.str())) continue;
        std::string_view rest = path.substr(key.str().size());
        toml::table* inner = node.as_table();
        if (toml::array* elements = node.as_array(); elements && rest.starts_with('[')) {
            std::size_t index = 0;
            const char* const end = std::from_chars(rest.data() + 1, rest.data() + rest.size(), index).ptr;
            rest.remove_prefix(std::min(rest.size(), std::size_t(end - rest.data()) + 1));
            inner = index < elements->size() ? (*elements)[index].as_table() : nullptr;
        }
        if (inner && rest.starts_with('.') && erase(*inner, rest.substr(1))) return true;
    }
    return false;
}

}  // namespace

void remove_key(toml::table& root, const std::string& path)
{
    if (!erase(root, path)) throw std::logic_error("no key " + path + " to remove");
}

std::string toml_value_text(const toml::node& node)
{
    constexpr std::size_t limit = 60;
    if (node.is_table()) return "a table";
    if (const auto* number = node.as_floating_point()) return number_text(number->get());
    std::ostringstream stream;
    node.visit([&](const auto& value) { stream << value; });
    std::string text = stream.str();
    if (text.size() > limit) text = text.substr(0, limit) + "...";
    return text;
}

}  // namespace selvage
