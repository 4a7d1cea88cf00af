#include "io/number_text.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace selvage {
namespace {

struct UnitSlip {
    std::string_view unit, meant;
    double factor;  ///< Number of `meant` in one `unit`.
};

// The units in which users are likely to give a value instead of the SI unit, the most likely first.
constexpr UnitSlip slips[] = {
    {"m", "mm", 1e3},     {"m", "cm", 1e2}, {"kg/m^2", "g/m^2", 1e3}, {"s", "ms", 1e3},
    {"N m", "uN m", 1e6}, {"N", "mN", 1e3}, {"N/m", "mN/m", 1e3},     {"Pa", "mPa", 1e3},
};

}  // namespace

std::string number_text(double value)
{
    const double size = std::abs(value);
    const bool plain = size == 0 || (size >= 1e-4 && size < 1e7);
    char text[32];
    const std::chars_format format = plain ? std::chars_format::fixed : std::chars_format::scientific;
    const std::to_chars_result end = std::to_chars(text, text + sizeof text, value, format);
    return {text, end.ptr};
}

std::string rounded_text(double value)
{
    char text[32];
    const std::to_chars_result end = std::to_chars(text, text + sizeof text, value, std::chars_format::general, 6);
    return {text, end.ptr};
}

std::string range_text(double low, double high, std::string_view unit)
{
    std::string text = number_text(low) + " to " + number_text(high);
    if (unit != "1") text += " " + std::string(unit);
    return text;
}

std::string unit_slip(double value, double low, double high, std::string_view unit)
{
    if (unit == "1" || !std::isfinite(value)) return {};
    const auto fits = [&](double candidate) { return candidate >= low && candidate <= high; };
    const std::string unit_name(unit);
    for (const UnitSlip& slip : slips)
        if (slip.unit == unit && value > high && fits(value / slip.factor))
            return rounded_text(value / slip.factor) + " " + unit_name + " (" + rounded_text(value) + " " +
                   std::string(slip.meant) + ")";
    for (const double factor : {10.0, 100.0, 1000.0}) {
        const double candidate = value > high ? value / factor : value * factor;
        if (fits(candidate) && candidate != 0) return rounded_text(candidate) + " " + unit_name;
    }
    return {};
}

bool parse_number(std::string_view text, double& value)
{
    const std::from_chars_result end = std::from_chars(text.data(), text.data() + text.size(), value);
    return end.ec == std::errc() && end.ptr == text.data() + text.size() && std::isfinite(value);
}

}  // namespace selvage
