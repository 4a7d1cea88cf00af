#pragma once
#include "host/solver/state/state.hpp"
#include "host/solver/terms/params.hpp"

/// Sets the member of an argument struct `a` that has the name of a field of `state`: the two names have to be there.
/// Lists like <stage>_FIELDS of kernels/stages are expanded with it.
#define BIND_FIELD(name) a.name = state.name.data();

namespace selvage {

/// Returns a term's arguments, such as cloth_contact_args: fields and parameters bound by name, so that none is left
/// out. @param projected  see stiffness_mode
template <class Args>
Args bound(State& state, const Params& params, bool projected = false);

#define SET_PARAM(name, initial, unit, meaning) a.name = values.name;
#define TERM(term, kind, nature, stage, family)                                                \
    template <>                                                                                \
    inline term##_args bound<term##_args>(State & state, const Params& params, bool projected) \
    {                                                                                          \
        const auto& values = params.term;                                                      \
        term##_args a;                                                                         \
        a.size = state.size;                                                                   \
        a.mode.projected = projected;                                                          \
        term##_FIELDS(BIND_FIELD, BIND_FIELD) term##_PARAMS(SET_PARAM, SET_PARAM) return a;    \
    }
TERMS(TERM)
#undef TERM
#undef SET_PARAM

}  // namespace selvage
