#pragma once
#include <string>
#include <string_view>

#include "io/errors.hpp"

namespace selvage {

/// Returns JSON text in which comments and commas before a closing bracket are blanks; every other byte stays where it
/// was, so that places in the one are places in the other.
/// @param file  for messages
/// @throws InputError with line and column for brackets nested deeper than a pattern needs, and for text that is not
///         UTF-8 but UTF-16
std::string plain_json(std::string_view text, const std::string& file);

/// Returns the place of a byte of a text. Lines end with LF, CR LF or CR.
InputPlace place_of_byte(std::string_view text, std::size_t byte, const std::string& file);

/// Returns the place in a text of the value at a key path such as `pattern.panels.front.edges[3]`, or of the innermost
/// value around it that is there.
/// @param text  valid JSON without comments
InputPlace place_of_value(std::string_view text, const std::string& file, const std::string& path);

/// Returns the offset of the n-th key of a valid text, counted from 1 over all its objects.
std::size_t offset_of_key(std::string_view text, int count);

}  // namespace selvage
