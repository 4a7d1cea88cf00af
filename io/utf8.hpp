#pragma once
#include <string>
#include <string_view>

namespace selvage {

/// Returns text with every byte that is no UTF-8 replaced by U+FFFD; file names may hold any bytes.
std::string valid_utf8(std::string_view text);

/// The same for a terminal: control characters are replaced as well, for a file's text could move its cursor, change
/// its title or worse.
std::string printable(std::string_view text);

}  // namespace selvage
