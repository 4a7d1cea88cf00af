#include "io/errors.hpp"

#include <algorithm>
#include <numeric>
#include <vector>

#include "io/utf8.hpp"

namespace selvage {
namespace {

std::string sentence(const InputPlace& place, std::string_view found, std::string_view expected,
                     std::string_view nearest)
{
    std::string text = describe(place);
    if (!text.empty()) text += ": ";
    text += "found " + std::string(found) + ", expected " + std::string(expected);
    if (!nearest.empty()) text += " (did you mean `" + std::string(nearest) + "`?)";
    return text;
}

// Levenshtein distance by the two-row recurrence.
int edit_distance(std::string_view a, std::string_view b)
{
    std::vector<int> above(b.size() + 1), row(b.size() + 1);
    std::iota(above.begin(), above.end(), 0);
    for (std::size_t i = 0; i < a.size(); ++i) {
        row[0] = int(i) + 1;
        for (std::size_t j = 0; j < b.size(); ++j)
            row[j + 1] = std::min({above[j + 1] + 1, row[j] + 1, above[j] + (a[i] != b[j])});
        std::swap(above, row);
    }
    return above.back();
}

}  // namespace

std::string describe(const InputPlace& place)
{
    std::string text = valid_utf8(place.file);
    if (place.line > 0) text += ":" + std::to_string(place.line);
    if (place.line > 0 && place.column > 0) text += ":" + std::to_string(place.column);
    if (!text.empty() && !place.key.empty()) text += ": ";
    return text + place.key;
}

InputError::InputError(const InputPlace& place, std::string_view found, std::string_view expected,
                       std::string_view nearest)
    : std::runtime_error(sentence(place, found, expected, nearest))
{
}

std::string nearest_name(std::string_view name, std::span<const std::string> candidates)
{
    std::string best;
    int best_distance = std::max<int>(2, int(name.size()) / 2);
    for (const std::string& candidate : candidates) {
        const int distance = edit_distance(name, candidate);
        if (distance < best_distance || (distance == best_distance && best.empty())) {
            best = candidate;
            best_distance = distance;
        }
    }
    return best;
}

}  // namespace selvage
