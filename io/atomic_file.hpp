#pragma once
#include <string>
#include <string_view>

namespace selvage {

/// Returns the temporary name under which a file is written before it is renamed to `path`. It is in the same folder
/// and always the same, so that killed runs leave at most one temporary file behind.
std::string temporary_name(const std::string& path);

/// Synchronises a finished temporary file to the disk and renames it to `path`, so that readers see either the old or
/// the new file.
/// @throws InputError if the folder cannot be written.
void move_into_place(const std::string& temporary, const std::string& path);

/// Writes a whole text file under its temporary name and moves it into place.
/// @throws InputError if the folder cannot be written.
void write_file_atomically(const std::string& path, std::string_view text);

/// Returns the file name of a path without its folder.
std::string file_name(const std::string& path);

}  // namespace selvage
