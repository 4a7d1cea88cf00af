#pragma once
#include "host/solver/terms/params.hpp"

namespace selvage {

/// Returns parameters with every strength set to one, so that every term is active, in moving air.
inline Params unit_strengths()
{
    Params params;
#define STRENGTH(name, initial, unit, meaning) values.name = 1;
#define PARAM(name, initial, unit, meaning)
#define TERM(term, per, nature, stage, family) \
    {                                          \
        auto& values = params.term;            \
        term##_PARAMS(STRENGTH, PARAM)         \
    }
    TERMS(TERM)
#undef TERM
#undef PARAM
#undef STRENGTH
    // Only air that moves presses on cloth at rest.
    params.wind.velocity_x = params.air_drag.velocity_x = 2;
    params.wind.velocity_y = params.air_drag.velocity_y = -1;
    params.wind.velocity_z = params.air_drag.velocity_z = 0.5;
    return params;
}

}  // namespace selvage
