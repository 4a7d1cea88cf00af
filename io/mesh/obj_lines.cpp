#include "io/mesh/obj_lines.hpp"

#include <algorithm>
#include <array>

namespace selvage {
namespace {

// What looks like a space, or like nothing, in UTF-8: the mark at the start of a file, the hard blank, the blanks from
// U+2000 to U+200B, the narrow and the wide one.
std::size_t length_of_blank(std::string_view text)
{
    constexpr std::array<std::string_view, 4> blanks{"\xEF\xBB\xBF", "\xC2\xA0", "\xE2\x80\xAF", "\xE3\x80\x80"};
    for (const std::string_view blank : blanks)
        if (text.starts_with(blank)) return blank.size();
    const bool general = text.starts_with("\xE2\x80") && text.size() > 2;
    if (general && static_cast<unsigned char>(text[2]) >= 0x80 && static_cast<unsigned char>(text[2]) <= 0x8B) return 3;
    return 0;
}

void replace_blanks(std::string& text)
{
    if (std::all_of(text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) < 0x80; })) return;
    for (std::size_t k = 0; k < text.size(); ++k) {
        if (static_cast<unsigned char>(text[k]) < 0x80) continue;
        const std::size_t length = length_of_blank(std::string_view(text).substr(k));
        // In Latin-1 the hard blank is a byte of its own, which in UTF-8 only follows another high one.
        const bool latin = text[k] == '\xA0' && (k == 0 || static_cast<unsigned char>(text[k - 1]) < 0x80);
        std::fill_n(text.begin() + std::ptrdiff_t(k), latin ? 1 : length, ' ');
    }
}

// Names and comments may end in a backslash that means nothing, as the paths of some systems do.
bool holds_numbers(std::string_view line)
{
    const std::size_t word = line.find_first_not_of(" \t");
    return word != std::string_view::npos && (line[word] == 'v' || line[word] == 'f');
}

}  // namespace

ObjLines::ObjLines(std::string text) : text_(std::move(text)) { replace_blanks(text_); }

std::size_t ObjLines::end_of_line(std::size_t from) const
{
    while (from < text_.size() && text_[from] != '\n' && text_[from] != '\r') ++from;
    return from;
}

void ObjLines::skip_line_end(std::size_t end)
{
    const bool pair = text_.compare(end, 2, "\r\n") == 0;
    at_ = std::min(end + (pair ? 2 : 1), text_.size());
    ++lines_read_;
}

bool ObjLines::next()
{
    if (at_ >= text_.size()) return false;
    const std::size_t begin = at_;
    number_ = lines_read_ + 1;
    std::size_t end = end_of_line(begin);
    skip_line_end(end);
    const bool joins = holds_numbers(std::string_view(text_).substr(begin, end - begin));
    while (joins && end > begin && text_[end - 1] == '\\' && at_ < text_.size()) {
        std::fill(text_.begin() + std::ptrdiff_t(end) - 1, text_.begin() + std::ptrdiff_t(at_), ' ');
        end = end_of_line(at_);
        skip_line_end(end);
    }
    line_ = std::string_view(text_).substr(begin, end - begin);
    return true;
}

}  // namespace selvage
