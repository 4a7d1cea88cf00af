#pragma once
#include <algorithm>

#include "kernels/terms.h"
#include "kernels/velocity_filters.h"

namespace selvage {

/// The parameters of every term and rule, as `params.<term>.<parameter>`, in SI units. All strengths are zero at first.
struct Params {
#define PARAM(name, initial, unit, meaning) real name = real(initial);
#define TERM(term, per, nature, stage, family) \
    struct {                                   \
        term##_PARAMS(PARAM, PARAM)            \
    } term;
    TERMS(TERM)
#undef TERM
#define VELOCITY_FILTER(rule, per)  \
    struct {                        \
        rule##_PARAMS(PARAM, PARAM) \
    } rule;
    VELOCITY_FILTERS(VELOCITY_FILTER)
#undef VELOCITY_FILTER
#undef PARAM
};

/// True if the cloth meets bodies, under whichever law of contact.
inline bool meets_bodies(const Params& p)
{
    return p.body_contact.stiffness > 0 || p.body_repulsion.stiffness > 0 || p.velocity_rule.gap > 0;
}

/// True if the cloth meets itself, under whichever law of contact.
inline bool meets_itself(const Params& p) { return p.cloth_contact.stiffness > 0 || p.cloth_repulsion.stiffness > 0; }

/// Pressure scale of contact under the law in use [Pa]; 0 without contact by forces.
inline double contact_stiffness(const Params& p)
{
    return std::max(
        {p.body_contact.stiffness, p.body_repulsion.stiffness, p.cloth_contact.stiffness, p.cloth_repulsion.stiffness});
}

/// True if air acts on the cloth, moving or still.
inline bool meets_air(const Params& p)
{
    return p.wind.normal > 0 || p.wind.tangential > 0 || p.air_drag.normal > 0 || p.air_drag.tangential > 0;
}

/// Distance from a body at which contact sets in under the law in use [m]; the barrier's if there is none.
inline double body_gap(const Params& p)
{
    if (p.velocity_rule.gap > 0) return p.velocity_rule.gap;
    return p.body_repulsion.stiffness > 0 ? p.body_repulsion.gap : p.body_contact.gap;
}

/// Distance at which contact of cloth with cloth sets in under the law in use, as far as no place needs another [m].
inline double cloth_gap(const Params& p)
{
    return p.cloth_repulsion.stiffness > 0 ? p.cloth_repulsion.gap : p.cloth_contact.gap;
}

}  // namespace selvage
