#pragma once
#include <string>
#include <string_view>

namespace selvage {

/// Returns text with every byte that is no UTF-8 replaced by U+FFFD; file names may hold any bytes.
std::string valid_utf8(std::string_view text);

}  // namespace selvage
