#include "io/utf8.hpp"

#include <cstddef>

namespace selvage {
namespace {

// Returns the length of the UTF-8 sequence at the start of a text, 0 if there is none (RFC 3629, section 4).
std::size_t sequence_length(std::string_view text)
{
    const auto byte = [&](std::size_t k) { return k < text.size() ? static_cast<unsigned char>(text[k]) : 0u; };
    const unsigned first = byte(0);
    if (first < 0x80) return 1;
    const std::size_t length = first >= 0xc2 && first < 0xe0 ? 2 : first < 0xf0 ? 3 : first < 0xf5 ? 4 : 0;
    if (first < 0xc2 || length == 0) return 0;
    for (std::size_t k = 1; k < length; ++k)
        if ((byte(k) & 0xc0) != 0x80) return 0;
    const bool overlong = (first == 0xe0 && byte(1) < 0xa0) || (first == 0xf0 && byte(1) < 0x90);
    const bool surrogate = first == 0xed && byte(1) >= 0xa0, beyond = first == 0xf4 && byte(1) >= 0x90;
    return overlong || surrogate || beyond ? 0 : length;
}

// @param controls  replaced as well: U+0000 to U+001F, U+007F and U+0080 to U+009F
std::string sound_text(std::string_view text, bool controls)
{
    std::string sound;
    while (!text.empty()) {
        const std::size_t length = sequence_length(text);
        const auto first = static_cast<unsigned char>(text[0]);
        const bool of_two = first == 0xc2 && length == 2 && static_cast<unsigned char>(text[1]) < 0xa0;
        const bool is_control = first < 0x20 || first == 0x7f || of_two;
        const bool kept = length > 0 && !(controls && is_control);
        sound += kept ? text.substr(0, length) : "\xef\xbf\xbd";
        text.remove_prefix(length > 0 ? length : 1);
    }
    return sound;
}

}  // namespace

std::string valid_utf8(std::string_view text) { return sound_text(text, false); }

std::string printable(std::string_view text) { return sound_text(text, true); }

}  // namespace selvage
