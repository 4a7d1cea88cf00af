#pragma once
#include <string>
#include <string_view>

namespace selvage {

/// Returns the name under which a file is written before it takes its place: same folder, always the same
/// name, so that killed runs leave at most one behind.
std::string temporary_name(const std::string& path);

/// Brings a finished temporary file to the disk and renames it to `path`: readers see the old or the new file.
/// @throws InputError if the folder cannot be written.
void move_into_place(const std::string& temporary, const std::string& path);

/// Writes a whole text file through its temporary name.
/// @throws InputError if the folder cannot be written.
void write_file_atomically(const std::string& path, std::string_view text);

/// The file name of a path without its folder.
std::string file_name(const std::string& path);

}  // namespace selvage
