#include "io/pattern/pattern.hpp"

#include <utility>

#include "io/number_text.hpp"
#include "io/pattern/json_text.hpp"

namespace selvage {

InputPlace Pattern::place(const std::string& key) const
{
    return text.empty() ? InputPlace{file, 0, 0, key} : place_of_value(text, file, key);
}

std::string unit_meanings(double units)
{
    constexpr std::pair<double, const char*> meanings[] = {{1, "metres"}, {39.37, "inches"}, {100, "cm"}, {1000, "mm"}};
    std::string text;
    for (const auto& [per_metre, unit] : meanings)
        text += (text.empty() ? "" : ", ") + number_text(per_metre) + " (" + unit + ") would mean " +
                rounded_text(units / per_metre) + " m";
    return text;
}

}  // namespace selvage
