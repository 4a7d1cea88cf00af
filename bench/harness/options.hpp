#pragma once
#include <charconv>
#include <map>
#include <string>
#include <vector>

#include "io/errors.hpp"

namespace selvage {

/// Reads `--name value` and `--name=value`.
/// @param suite     for error messages, such as "bench kernels"
/// @param names     the options that are known, such as "--vertices"
/// @param expected  for error messages: the options with their values
/// @return the text of the value of each option that was given
/// @throws InputError for an unknown name or a missing value
std::map<std::string, std::string> read_options(const std::string& suite, const std::vector<std::string>& options,
                                                const std::vector<std::string>& names, const std::string& expected);

/// Reads the value of an option as a number in [low, high].
/// @throws InputError naming the option, the value and what was expected
template <class Number>
Number read_number(const std::string& name, const std::string& text, Number low, Number high,
                   const std::string& expected)
{
    Number value{};
    const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (fault != std::errc() || end != text.data() + text.size() || !(value >= low && value <= high))
        throw InputError({"", 0, 0, name}, "`" + text + "`", expected);
    return value;
}

}  // namespace selvage
