#pragma once
#include <string>
#include <string_view>

namespace selvage {

/// Reads a whole file.
/// @param kind  what the file should have been, for messages
/// @throws InputError if there is no such file or it cannot be read
std::string read_file_text(const std::string& path, std::string_view kind);

/// Reads at most so many bytes from the beginning of a file; else as read_file_text.
std::string read_file_start(const std::string& path, std::string_view kind, std::size_t most);

}  // namespace selvage
