#pragma once
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <toml++/toml.h>

#include "io/errors.hpp"
#include "io/geometry.hpp"
#include "io/words.hpp"

namespace selvage {

/// A parsed TOML text that remembers which of its values came from the command line.
struct TomlDocument {
    std::string file;  ///< As the user gave it.
    toml::table root;
    std::map<std::string, std::string> overrides;  ///< Key path to the override as given.
    std::map<std::string, InputPlace> places;      ///< Key path to its place, filled while tables are read.

    /// Returns the place of a key; the override stands for the file where it set the key.
    InputPlace place(const toml::source_region& region, const std::string& key) const;
};

/// Parses TOML text.
/// @throws InputError with line and column where the text is not TOML or gives a key twice.
TomlDocument parse_toml(std::string_view text, const std::string& file);

/// Sets `table.key=value` in a document; `sheet.KEY` and `body.KEY` set every element, `sheet[1].KEY` only one.
/// @throws InputError naming the override where it cannot be read or its element does not exist.
void apply_override(TomlDocument& document, const std::string& override_text);

/// Removes the key of a path such as `sheet[1].width` from a text that has it.
void remove_key(toml::table& root, const std::string& path);

/// Returns a TOML value as text for messages, shortened where it is long.
std::string toml_value_text(const toml::node& node);

/// Reads the keys of one table and checks type, range and spelling.
/// Every `read` leaves its target unchanged when the key is absent and throws InputError when it is wrong.
class TableReader {
public:
    /// @param table  nullptr: an absent table, in which every key keeps its default
    /// @param path   key path of the table, empty for the whole text
    TableReader(TomlDocument& document, const toml::table* table, std::string path);

    void read(const char* name, double& target, const char* unit, double low, double high);
    void read(const char* name, int& target, const char* unit, double low, double high);
    void read(const char* name, bool& target, const char* unit, double low, double high);
    void read(const char* name, Vec3& target, const char* unit);
    /// Reads any text.
    void read(const char* name, std::string& target);
    /// Reads a word of an enumeration; "" stands for a key that is not given and is not accepted.
    template <WordEnum Choice>
    void read(const char* name, Choice& target)
    {
        if (const std::optional<std::string> word = read_word(name, words_of<Choice>()))
            target = find_word<Choice>(*word).value();
    }
    /// Reads up to `most` points [[strain, stress], ...] in which both numbers increase from above 0; a first point
    /// [0, 0] may be given and is left out of the target.
    void read(const char* name, std::vector<Vec2>& target, int most, double largest_strain, const char* strain_unit);
    /// Reads a list of texts.
    void read(const char* name, std::vector<std::string>& target);

    /// Returns a table inside this one, or nullptr.
    const toml::table* table(const char* name);
    /// Returns the elements of `[[name]]`; empty when there are none.
    std::vector<const toml::table*> tables(const char* name);

    /// Returns the place of a key of this table, given or not.
    InputPlace place(const std::string& name) const;
    const std::string& path() const { return path_; }

    /// @throws InputError at the first key that no `read` has asked for, with the nearest that one has.
    void refuse_unknown() const;

private:
    const toml::node* find(const char* name);
    /// Returns one of the words, or nothing when the key is absent.
    std::optional<std::string> read_word(const char* name, std::span<const std::string_view> words);
    std::string key_path(std::string_view name) const;
    [[noreturn]] void refuse(const char* name, const toml::node& node, std::string_view expected,
                             std::string_view nearest = {}) const;
    void check_range(const char* name, const toml::node& node, double value, std::string_view kind, const char* unit,
                     double low, double high) const;

    TomlDocument& document_;
    const toml::table* table_;
    std::string path_;
    std::vector<std::string> known_;
};

}  // namespace selvage
