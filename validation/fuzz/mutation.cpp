#include "validation/fuzz/mutation.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <string_view>

namespace selvage {
namespace {

constexpr std::array<std::string_view, 30> odd_words{"0",
                                                     "-0",
                                                     "-1",
                                                     "1e-320",
                                                     "1e308",
                                                     "1e999",
                                                     "nan",
                                                     "inf",
                                                     "2147483648",
                                                     "-2147483649",
                                                     "18446744073709551616",
                                                     "0.1",
                                                     "1/2/3",
                                                     "//",
                                                     "\"\"",
                                                     "[]",
                                                     "{}",
                                                     "null",
                                                     "true",
                                                     "\"a\\nb\"",
                                                     "\xff",
                                                     "\xef\xbb\xbf",
                                                     "=",
                                                     "#",
                                                     "[[",
                                                     "]]",
                                                     "1,000",
                                                     "0x10",
                                                     "\\",
                                                     "\xc2\xa0"};

struct Span {
    std::size_t begin, end;
};

// A run of characters of one sort that holds a random place: a number or word, or a sign.
Span word_at_random(const std::string& text, Chance& chance)
{
    const auto in_word = [&](std::size_t at) {
        const auto c = static_cast<unsigned char>(text[at]);
        return std::isalnum(c) || c == '.' || c == '-' || c == '_' || c == '+';
    };
    std::size_t begin = below(text.size(), chance), end = begin + 1;
    if (!in_word(begin)) return {begin, end};
    while (begin > 0 && in_word(begin - 1)) --begin;
    while (end < text.size() && in_word(end)) ++end;
    return {begin, end};
}

Span line_at_random(const std::string& text, Chance& chance)
{
    const std::size_t at = below(text.size(), chance), before = text.rfind('\n', at == 0 ? 0 : at - 1);
    const std::size_t begin = at == 0 || before == std::string::npos ? 0 : before + 1;
    return {begin, std::min(text.find('\n', begin), text.size() - 1) + 1};
}

// A bracket with what it holds, where the text has one after a random place.
Span bracket_at_random(const std::string& text, Chance& chance)
{
    const std::size_t begin = text.find_first_of("[{(\"", below(text.size(), chance));
    if (begin == std::string::npos) return line_at_random(text, chance);
    int depth = 0;
    for (std::size_t at = begin; at < text.size(); ++at) {
        if (std::string_view("[{(").find(text[at]) != std::string_view::npos) ++depth;
        if (std::string_view("]})").find(text[at]) != std::string_view::npos && --depth <= 0) return {begin, at + 1};
    }
    return {begin, begin + 1};
}

Span part_at_random(const std::string& text, Chance& chance)
{
    switch (below(3, chance)) {
        case 0:
            return word_at_random(text, chance);
        case 1:
            return line_at_random(text, chance);
        default:
            return bracket_at_random(text, chance);
    }
}

void change_text(std::string& text, const std::vector<std::string>& corpus, Chance& chance)
{
    constexpr std::size_t most_copies = 300;
    const Span part = part_at_random(text, chance);
    const std::string held = text.substr(part.begin, part.end - part.begin);
    switch (below(9, chance)) {
        case 0: {
            const Span word = word_at_random(text, chance);
            text.replace(word.begin, word.end - word.begin, odd_words[below(odd_words.size(), chance)]);
            break;
        }
        case 1:
        case 2: {
            // Often one number for another, so that what is read is examined as well.
            const Span word = word_at_random(text, chance), other = word_at_random(text, chance);
            text.replace(word.begin, word.end - word.begin, text.substr(other.begin, other.end - other.begin));
            break;
        }
        case 3:
            text.erase(part.begin, held.size());
            break;
        case 4:
            text.insert(below(text.size(), chance), held);
            break;
        case 5: {
            const std::string& other = corpus[below(corpus.size(), chance)];
            if (other.empty()) break;
            const Span foreign = part_at_random(other, chance);
            text.replace(part.begin, held.size(), other, foreign.begin, foreign.end - foreign.begin);
            break;
        }
        case 6: {
            std::string copies;
            for (std::size_t k = below(most_copies, chance); k > 0 && copies.size() < 20000; --k) copies += held;
            text.insert(part.begin, copies);
            break;
        }
        case 7:
            text[below(text.size(), chance)] = char(below(256, chance));
            break;
        default:
            text.resize(below(text.size() + 1, chance));
    }
}

}  // namespace

std::size_t below(std::size_t count, Chance& chance) { return count == 0 ? 0 : std::size_t(chance() % count); }

std::string mutated_text(const std::string& text, const std::vector<std::string>& corpus, Chance& chance)
{
    std::string result = text;
    const std::size_t changes = below(2, chance) == 0 ? 1 : 1 + below(4, chance);
    for (std::size_t k = changes; k > 0 && !result.empty(); --k) change_text(result, corpus, chance);
    return result;
}

std::string mutated_bytes(const std::string& bytes, Chance& chance)
{
    constexpr std::array<std::uint64_t, 8> odd_numbers{0, 1, 255, 65535, 0x7fffffff, 0xffffffff, 1ull << 40, ~0ull};
    std::string result = bytes;
    for (std::size_t k = 1 + below(6, chance); k > 0 && !result.empty(); --k) {
        // Structure lies at the beginning of a file and of its blocks, which begin at multiples of 8.
        const std::size_t reach = below(2, chance) == 0 ? std::min<std::size_t>(result.size(), 8192) : result.size();
        std::size_t at = below(reach, chance);
        switch (below(6, chance)) {
            case 0:
            case 1:
                result[at] = char(below(256, chance));
                break;
            case 2:
                result[at] = char(result[at] ^ 1 << below(8, chance));
                break;
            case 3: {
                at -= at % 8;
                const std::uint64_t number = odd_numbers[below(odd_numbers.size(), chance)];
                const std::size_t length = std::size_t(1) << below(4, chance);
                for (std::size_t b = 0; b < length && at + b < result.size(); ++b)
                    result[at + b] = char(number >> 8 * b);
                break;
            }
            case 4: {
                const std::size_t from = below(reach, chance), length = below(64, chance);
                const std::string held = result.substr(from, length);
                for (std::size_t b = 0; b < held.size() && at + b < result.size(); ++b) result[at + b] = held[b];
                break;
            }
            default:
                if (below(8, chance) == 0) result.resize(at);
        }
    }
    return result;
}

}  // namespace selvage
