#pragma once
#include <string>
#include <string_view>

namespace selvage {

/// Reads a whole file.
/// @param kind  what the file should have been, for messages
/// @throws InputError if there is no such file or it cannot be read
std::string read_file_text(const std::string& path, std::string_view kind);

}  // namespace selvage
