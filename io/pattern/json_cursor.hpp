#pragma once
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "io/errors.hpp"
#include "io/geometry.hpp"

namespace selvage {

using OrderedJson = nlohmann::ordered_json;

/// Parses JSON text.
/// @throws InputError with line and column where it is malformed or an object has a key twice.
OrderedJson parse_json(std::string_view text, const std::string& file);

/// A value in a JSON document and the key path that leads to it. Every function throws InputError with that path.
class JsonCursor {
public:
    JsonCursor(const OrderedJson& value, const std::string& file, std::string path)
        : value_(&value), file_(&file), path_(std::move(path))
    {
    }

    /// Returns the value of a key that must exist.
    JsonCursor at(const std::string& key) const;
    /// Returns an element of a list; the index must exist.
    JsonCursor at(int index) const;
    bool has(const std::string& key) const;

    const OrderedJson& value() const { return *value_; }
    int size() const { return int(value_->size()); }

    const JsonCursor& object() const;
    /// Requires a list.
    /// @param expected  what the list should hold, for error messages; the same holds for the functions below
    const JsonCursor& list(std::string_view expected) const;
    double number(std::string_view expected) const;
    int integer(std::string_view expected) const;
    std::string text(std::string_view expected) const;
    /// Reads true, false, 1 or 0.
    bool flag(std::string_view expected) const;
    Vec2 vector2(std::string_view expected) const;
    Vec3 vector3(std::string_view expected) const;

    InputPlace place() const { return {*file_, 0, 0, path_}; }
    [[noreturn]] void refuse(std::string_view expected, std::string_view nearest = {}) const;
    [[noreturn]] void refuse_as(std::string_view found, std::string_view expected, std::string_view nearest = {}) const;

private:
    const OrderedJson* value_;
    const std::string* file_;
    std::string path_;
};

}  // namespace selvage
