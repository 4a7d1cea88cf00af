#pragma once
#include <string>
#include <string_view>

namespace selvage {

/// The lines of an OBJ file, however its writer ended and joined them: lines end in LF, CR LF or CR; a backslash at the
/// end of a line with numbers joins the next one to it; byte order marks and the blanks of Unicode count as spaces.
class ObjLines {
public:
    explicit ObjLines(std::string text);

    /// Moves to the next line. @return false at the end of the text
    bool next();
    std::string_view line() const { return line_; }  ///< Without its end; valid until the next call of next().
    int number() const { return number_; }           ///< Of its first line in the file, from 1.

private:
    std::size_t end_of_line(std::size_t from) const;
    void skip_line_end(std::size_t end);

    std::string text_;
    std::string_view line_;
    std::size_t at_ = 0;
    int number_ = 0, lines_read_ = 0;
};

}  // namespace selvage
