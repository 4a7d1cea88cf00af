#pragma once
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "io/errors.hpp"
#include "io/geometry.hpp"

namespace selvage {

using OrderedJson = nlohmann::ordered_json;

/// A parsed JSON text.
struct JsonDocument {
    std::string file;
    std::string text;  ///< Without comments; for the places of values.
    OrderedJson root;
};

/// Parses JSON text, which may hold comments and a comma behind the last element.
/// @throws InputError with line and column where it is malformed, nested too deep, or an object has a key twice.
JsonDocument parse_json(std::string_view text, const std::string& file);

/// A value in a JSON document and the key path that leads to it. Every function throws InputError with that path and
/// its line.
class JsonCursor {
public:
    explicit JsonCursor(const JsonDocument& document) : JsonCursor(document, document.root, {}) {}

    /// Returns the value of a key that must exist.
    JsonCursor at(const std::string& key) const;
    /// Returns an element of a list; the index must exist.
    JsonCursor at(int index) const;
    /// Returns whether a key is there that may be left out.
    /// @throws InputError if one is there instead that looks like a slip of the pen
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

    const std::string& path() const { return path_; }
    /// Returns where the value stands, which is searched in the whole text: for messages only.
    InputPlace place() const { return place_of(path_); }
    /// Returns the place of any key path of the document.
    InputPlace place_of(const std::string& path) const;
    [[noreturn]] void refuse(std::string_view expected, std::string_view nearest = {}) const;
    [[noreturn]] void refuse_as(std::string_view found, std::string_view expected, std::string_view nearest = {}) const;

private:
    JsonCursor(const JsonDocument& document, const OrderedJson& value, std::string path)
        : document_(&document), value_(&value), path_(std::move(path))
    {
    }

    const JsonDocument* document_;
    const OrderedJson* value_;
    std::string path_;
};

}  // namespace selvage
