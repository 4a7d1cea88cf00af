#include "io/pattern/json_cursor.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "io/pattern/json_text.hpp"

namespace selvage {
namespace {

std::string short_text(const OrderedJson& value)
{
    constexpr std::size_t limit = 60;
    if (value.is_object()) return "an object";
    std::string text = value.dump(-1, ' ', false, OrderedJson::error_handler_t::replace);
    if (text.size() > limit) text = text.substr(0, limit) + "...";
    return text;
}

// Removes the library's name, error number and position from the start of its message; InputPlace has the position.
std::string plain_message(const std::string& message)
{
    const std::size_t error = message.find("syntax error");
    if (error != std::string::npos) return message.substr(error);
    const std::size_t name = message.find("] ");
    return name == std::string::npos ? message : message.substr(name + 2);
}

// Returns what a message has in single quotes, which is the number that is too large; all of it if there are none.
std::string quoted(const std::string& message)
{
    const std::size_t open = message.find('\''), close = message.rfind('\'');
    return open == close ? message : message.substr(open + 1, close - open - 1);
}

// Whether two names differ in no more than two neighbouring letters.
bool looks_like(std::string_view name, std::string_view wanted)
{
    const auto same = std::ranges::mismatch(name, wanted);
    const auto front = std::size_t(same.in1 - name.begin());
    const std::string_view a = name.substr(front), b = wanted.substr(front);
    const auto behind = std::mismatch(a.rbegin(), a.rend(), b.rbegin(), b.rend());
    return std::max(a.rend() - behind.first, b.rend() - behind.second) <= 2;
}

}  // namespace

JsonDocument parse_json(std::string_view text, const std::string& file)
{
    JsonDocument document{file, plain_json(text, file), {}};
    std::vector<std::set<std::string>> keys;
    int key_count = 0;
    const auto refuse_twice = [&](int, OrderedJson::parse_event_t event, OrderedJson& value) {
        if (event == OrderedJson::parse_event_t::object_start) keys.emplace_back();
        if (event == OrderedJson::parse_event_t::object_end) keys.pop_back();
        if (event != OrderedJson::parse_event_t::key) return true;
        ++key_count;
        if (!keys.back().insert(value.get<std::string>()).second) {
            InputPlace place = place_of_byte(document.text, offset_of_key(document.text, key_count), file);
            place.key = value.get<std::string>();
            throw InputError(place, "the key twice in one object", "each key once");
        }
        return true;
    };
    try {
        document.root = OrderedJson::parse(document.text.begin(), document.text.end(), refuse_twice);
    } catch (const OrderedJson::parse_error& error) {
        throw InputError(place_of_byte(document.text, std::max<std::size_t>(error.byte, 1) - 1, file),
                         plain_message(error.what()), "valid JSON");
    } catch (const OrderedJson::exception& error) {
        const std::string message = plain_message(error.what());
        throw InputError(place_of_byte(document.text, document.text.find(quoted(message)), file), message,
                         "valid JSON");
    }
    return document;
}

InputPlace JsonCursor::place_of(const std::string& path) const
{
    return place_of_value(document_->text, document_->file, path);
}

void JsonCursor::refuse(std::string_view expected, std::string_view nearest) const
{
    refuse_as(short_text(*value_), expected, nearest);
}

void JsonCursor::refuse_as(std::string_view found, std::string_view expected, std::string_view nearest) const
{
    throw InputError(place(), found, expected, nearest);
}

bool JsonCursor::has(const std::string& key) const
{
    if (!value_->is_object() || value_->contains(key)) return value_->is_object();
    for (const auto& [name, value] : value_->items())
        if (looks_like(name, key)) at(key);
    return false;
}

JsonCursor JsonCursor::at(const std::string& key) const
{
    object();
    const auto item = value_->find(key);
    if (item == value_->end()) {
        std::vector<std::string> names;
        for (const auto& [name, value] : value_->items()) names.push_back(name);
        const std::string near = nearest_name(key, names);
        const std::string found = near.empty() ? "no key `" + key + "`" : "`" + near + "` and no key `" + key + "`";
        refuse_as(found, "the key `" + key + "`");
    }
    return {*document_, *item, path_.empty() ? key : path_ + "." + key};
}

JsonCursor JsonCursor::at(int index) const
{
    return {*document_, value_->at(std::size_t(index)), path_ + "[" + std::to_string(index) + "]"};
}

const JsonCursor& JsonCursor::object() const
{
    if (!value_->is_object()) refuse("an object {...}");
    return *this;
}

const JsonCursor& JsonCursor::list(std::string_view expected) const
{
    if (!value_->is_array()) refuse(expected);
    return *this;
}

double JsonCursor::number(std::string_view expected) const
{
    if (!value_->is_number() || !std::isfinite(value_->get<double>())) refuse(expected);
    return value_->get<double>();
}

int JsonCursor::integer(std::string_view expected) const
{
    const double value = number(expected);
    if (value != std::floor(value) || std::abs(value) > 1e9) refuse(expected);
    return int(value);
}

std::string JsonCursor::text(std::string_view expected) const
{
    if (!value_->is_string()) refuse(expected);
    return value_->get<std::string>();
}

bool JsonCursor::flag(std::string_view expected) const
{
    if (value_->is_boolean()) return value_->get<bool>();
    if (!value_->is_number() || (value_->get<double>() != 0 && value_->get<double>() != 1)) refuse(expected);
    return value_->get<double>() == 1;
}

Vec2 JsonCursor::vector2(std::string_view expected) const
{
    if (list(expected).size() != 2) refuse(expected);
    return {at(0).number("a number"), at(1).number("a number")};
}

Vec3 JsonCursor::vector3(std::string_view expected) const
{
    if (list(expected).size() != 3) refuse(expected);
    return {at(0).number("a number"), at(1).number("a number"), at(2).number("a number")};
}

}  // namespace selvage
