#include "host/examine/sizes.hpp"

#include <fmt/format.h>

#include "io/mesh/length_unit.hpp"

namespace selvage {

std::string sizes_by_unit(double extent, LengthUnit unit)
{
    std::string text;
    for (std::size_t k = 0; k < words_of<LengthUnit>().size(); ++k) {
        const LengthUnit other = LengthUnit(k);
        text += fmt::format("{}{:.3g} m as {}", k ? ", " : "", extent * metres_per(other) / metres_per(unit),
                            word_of(other));
    }
    return text;
}

}  // namespace selvage
