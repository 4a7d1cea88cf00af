#pragma once
#include "host/solver/terms/params.hpp"

namespace selvage {

/// Returns parameters with every strength set to one, so that every term is active.
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
    return params;
}

}  // namespace selvage
