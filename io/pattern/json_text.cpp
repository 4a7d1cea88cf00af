#include "io/pattern/json_text.hpp"

#include <algorithm>
#include <vector>

namespace selvage {
namespace {

// Patterns nest 9 brackets; values are printed and freed by recursion, so very many would exhaust the stack.
constexpr std::size_t deepest = 64;

constexpr std::string_view blanks = " \t\r\n";

bool is_any_of(char c, std::string_view set) { return set.find(c) != std::string_view::npos; }

std::size_t skip_blanks(std::string_view text, std::size_t at)
{
    return std::min(text.find_first_not_of(blanks, at), text.size());
}

// Returns the offset behind a string that starts at `at`; that of the text's end if it is not closed.
std::size_t skip_string(std::string_view text, std::size_t at)
{
    for (++at; at < text.size() && text[at] != '"'; ++at)
        if (text[at] == '\\') ++at;
    return std::min(at + 1, text.size());
}

// Returns the offset behind a value.
std::size_t skip_value(std::string_view text, std::size_t at)
{
    int depth = 0;
    while (at < text.size()) {
        if (text[at] == '"') {
            at = skip_string(text, at);
        } else if (is_any_of(text[at], "[{")) {
            ++depth, ++at;
        } else if (is_any_of(text[at], "]}")) {
            if (depth == 0) return at;
            --depth, ++at;
        } else {
            if (depth == 0 && is_any_of(text[at], ", \t\r\n")) return at;
            ++at;
            continue;
        }
        if (depth == 0) return at;
    }
    return at;
}

// Returns the offset behind a comment that starts at `at`, or `at` if none does. An open one ends with the text.
std::size_t skip_comment(std::string_view text, std::size_t at)
{
    const std::string_view start = text.substr(at, 2);
    if (start == "//") return std::min(text.find_first_of("\r\n", at), text.size());
    if (start != "/*") return at;
    const std::size_t end = text.find("*/", at + 2);
    return end == std::string_view::npos ? text.size() : end + 2;
}

void blank_out(std::string& text, std::size_t from, std::size_t to)
{
    for (; from < to; ++from)
        if (!is_any_of(text[from], "\r\n")) text[from] = ' ';
}

void refuse_utf16(std::string_view text, const std::string& file)
{
    if (text.starts_with("\xff\xfe") || text.starts_with("\xfe\xff") ||
        text.substr(0, 4).find('\0') != std::string_view::npos)
        throw InputError({file, 0, 0, {}}, "text in UTF-16 or UTF-32", "JSON text in UTF-8");
}

[[noreturn]] void refuse_depth(InputPlace place, const std::vector<std::string>& keys)
{
    for (const std::string& key : keys)
        if (!key.empty()) place.key += (place.key.empty() ? "" : ".") + key;
    throw InputError(place, "brackets nested more than " + std::to_string(deepest) + " deep", "values a few deep");
}

// Takes the key or index `part` from the front of a path. Returns false if the path leads elsewhere.
bool enter(std::string_view& path, const std::string& part)
{
    if (!path.starts_with(part)) return false;
    const std::string_view rest = path.substr(part.size());
    if (!rest.empty() && !is_any_of(rest.front(), ".[")) return false;
    path = rest.starts_with(".") ? rest.substr(1) : rest;
    return true;
}

}  // namespace

std::string plain_json(std::string_view text, const std::string& file)
{
    refuse_utf16(text, file);
    std::string plain(text);
    std::size_t comma = std::string::npos;  // the last byte but blanks, if it is a comma behind a value
    char last = '[';
    std::vector<std::string> keys;  // of each open bracket the last one, for the message
    for (std::size_t at = 0; at < plain.size();) {
        const std::size_t behind = skip_comment(plain, at);
        if (behind > at) {
            blank_out(plain, at, behind);
            at = behind;
            continue;
        }
        const char c = plain[at];
        if (is_any_of(c, "]}")) {
            if (comma != std::string::npos) plain[comma] = ' ';
            if (!keys.empty()) keys.pop_back();
        }
        if (is_any_of(c, "[{")) keys.emplace_back();
        if (keys.size() > deepest) refuse_depth(place_of_byte(plain, at, file), keys);
        if (!is_any_of(c, blanks)) {
            comma = c == ',' && !is_any_of(last, "[{,") ? at : std::string::npos;
            last = c;
        }
        const std::size_t end = c == '"' ? skip_string(plain, at) : at + 1;
        const std::size_t next = c == '"' ? skip_blanks(plain, end) : plain.size();
        if (next < plain.size() && plain[next] == ':' && !keys.empty())
            keys.back() = plain.substr(at + 1, end - at - 2);
        at = end;
    }
    return plain;
}

InputPlace place_of_byte(std::string_view text, std::size_t byte, const std::string& file)
{
    InputPlace place{file, 1, 1, {}};
    for (std::size_t at = 0; at < std::min(byte, text.size()); ++at) {
        const bool ends = text[at] == '\n' || (text[at] == '\r' && !text.substr(at + 1).starts_with('\n'));
        place.line += ends;
        place.column = ends ? 1 : place.column + 1;
    }
    return place;
}

InputPlace place_of_value(std::string_view text, const std::string& file, const std::string& path)
{
    std::string_view rest = path;
    std::size_t at = skip_blanks(text, text.starts_with("\xef\xbb\xbf") ? 3 : 0), found = at;
    while (!rest.empty() && at < text.size() && is_any_of(text[at], "[{")) {
        const bool is_object = text[at] == '{';
        bool entered = false;
        at = skip_blanks(text, at + 1);
        for (int index = 0; at < text.size() && !is_any_of(text[at], "]}"); ++index) {
            const std::size_t name_end = is_object ? skip_string(text, at) : at;
            const std::string part =
                is_object ? std::string(text.substr(at + 1, name_end - at - 2)) : "[" + std::to_string(index) + "]";
            if (is_object) at = skip_blanks(text, skip_blanks(text, name_end) + 1);
            entered = enter(rest, part);
            if (entered) break;
            at = skip_blanks(text, skip_value(text, at));
            if (at < text.size() && text[at] == ',') at = skip_blanks(text, at + 1);
        }
        if (!entered) break;
        found = at;
    }
    InputPlace place = place_of_byte(text, found, file);
    place.key = path;
    return place;
}

std::size_t offset_of_key(std::string_view text, int count)
{
    for (std::size_t at = 0; at < text.size();) {
        if (text[at] != '"') {
            ++at;
            continue;
        }
        const std::size_t behind = skip_string(text, at), next = skip_blanks(text, behind);
        if (next < text.size() && text[next] == ':' && --count == 0) return at;
        at = behind;
    }
    return text.size();
}

}  // namespace selvage
