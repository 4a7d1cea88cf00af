#pragma once
#include <algorithm>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

// WORD_ENUM(Type, LIST) defines `enum class Type` with the words of a list
//     #define LIST(WORD) WORD(name) WORD(name, "word") ...
// where "word" is what files say, if that is a keyword or no identifier at all, and makes words_of, word_of and
// find_word work for it. It stands in namespace selvage. Further arguments of WORD are ignored.
#define LIST_ENUMERATOR(name, ...) name,
#define LIST_WORD_IN_FILES(name, ...) words::in_files(#name __VA_OPT__(, ) __VA_ARGS__),
#define WORD_ENUM(Type, LIST)                                                      \
    enum class Type { LIST(LIST_ENUMERATOR) };                                     \
    inline constexpr std::string_view Type##_words[] = {LIST(LIST_WORD_IN_FILES)}; \
    constexpr std::span<const std::string_view> list_words(Type) { return Type##_words; }

namespace selvage::words {

constexpr std::string_view in_files(std::string_view name) { return name; }
constexpr std::string_view in_files(std::string_view, std::string_view word, auto...) { return word; }

}  // namespace selvage::words

namespace selvage {

/// An enumeration that WORD_ENUM has made.
template <class Type>
concept WordEnum = std::is_enum_v<Type> && requires(Type value)
{
    list_words(value);
};

/// Returns the words of an enumeration in the order of its values.
template <WordEnum Type>
constexpr std::span<const std::string_view> words_of()
{
    return list_words(Type{});
}

/// Returns the words that a file may give: all but "", which stands for a key that is not given.
inline std::vector<std::string> accepted_words(std::span<const std::string_view> words)
{
    std::vector<std::string> accepted;
    for (const std::string_view word : words)
        if (!word.empty()) accepted.emplace_back(word);
    return accepted;
}

/// Returns the word of a value.
constexpr std::string_view word_of(WordEnum auto value) { return list_words(value)[std::size_t(value)]; }

/// The same where text is put together with +.
std::string text_of(WordEnum auto value) { return std::string(word_of(value)); }

/// Returns the value of a word, or nothing if the enumeration does not have it.
template <WordEnum Type>
constexpr std::optional<Type> find_word(std::string_view word)
{
    const std::span<const std::string_view> words = words_of<Type>();
    const auto found = std::find(words.begin(), words.end(), word);
    if (found == words.end()) return std::nullopt;
    return Type(found - words.begin());
}

}  // namespace selvage
