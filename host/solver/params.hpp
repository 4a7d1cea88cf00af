#pragma once
#include "kernels/terms.h"

namespace selvage {

/// Every term's parameters, as `params.<term>.<parameter>`, in SI units. All strengths are zero at first.
struct Params {
#define PARAM(name, initial, unit, meaning) real name = real(initial);
#define TERM(term, per, nature, stage) struct { term##_PARAMS(PARAM, PARAM) } term;
    TERMS(TERM)
#undef TERM
#undef PARAM
};

}  // namespace selvage
