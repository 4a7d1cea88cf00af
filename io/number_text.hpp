#pragma once
#include <string>
#include <string_view>

namespace selvage {

/// Returns the shortest text that reads back as the same number.
std::string number_text(double value);

/// Returns the number rounded to six significant digits, for computed values.
std::string rounded_text(double value);

/// Returns `low to high unit` for messages and documentation; the unit "1" is left out.
std::string range_text(double low, double high, std::string_view unit);

/// Guesses the value that an out-of-range value means in another unit, such as `0.01 m (10 mm)` for 10.
/// @param low, high, unit  the accepted range of the key
/// @return "" if no common unit brings the value into the range
std::string unit_slip(double value, double low, double high, std::string_view unit);

/// Reads a whole text as a finite number.
/// @return false if the text is anything else
bool parse_number(std::string_view text, double& value);

}  // namespace selvage
