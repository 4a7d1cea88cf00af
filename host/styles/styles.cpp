#include "host/styles/styles.hpp"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "host/styles/blocks/placement.hpp"
#include "io/errors.hpp"

namespace selvage {
namespace {

constexpr Style catalogue[] = {
    {"tshirt", "T-shirt with a neck band and short sleeves", draft_tshirt},
    {"vest", "vest without sleeves", draft_vest},
    {"shirt", "buttoned shirt with a flat collar and long sleeves with cuffs", draft_shirt},
    {"hoody", "hoody with long sleeves with cuffs", draft_hoody},
    {"dress", "dress without sleeves, with bust and waist darts and a seam at the waist", draft_dress},
    {"trousers", "trousers with darts and a waistband", draft_trousers},
    {"gathered_skirt", "skirt of two rectangles, gathered to a waistband", draft_gathered_skirt},
    {"circle_skirt", "skirt of a whole circle with a waistband", draft_circle_skirt},
};

}  // namespace

std::span<const Style> styles() { return catalogue; }

std::vector<std::string> style_names()
{
    std::vector<std::string> names;
    for (const Style& style : catalogue) names.push_back(style.name);
    return names;
}

const Style& find_style(const std::string& name, const std::string& key)
{
    const auto* found = std::ranges::find_if(catalogue, [&](const Style& style) { return style.name == name; });
    if (found != std::end(catalogue)) return *found;
    InputPlace place;
    place.key = key;
    throw InputError(place, fmt::format("\"{}\"", name),
                     fmt::format("a built-in pattern: {}", fmt::join(style_names(), ", ")),
                     nearest_name(name, style_names()));
}

Pattern draft_style(const std::string& name, const StyleBody& body, const std::string& key)
{
    Pattern pattern = find_style(name, key).draft(body);
    move_to_mesh(pattern, body.frame);
    pattern.name = name;
    return pattern;
}

}  // namespace selvage
