#pragma once
#include "io/choices.hpp"

namespace selvage {

/// Returns the length of a unit [m].
constexpr double metres_per(LengthUnit unit)
{
    switch (unit) {
        case LengthUnit::dm:
            return 0.1;
        case LengthUnit::cm:
            return 0.01;
        case LengthUnit::mm:
            return 0.001;
        case LengthUnit::inch:
            return 0.0254;
        case LengthUnit::m:
            break;
    }
    return 1;
}

}  // namespace selvage
