// The list of velocity filters: they change positions and velocities directly after a step instead of adding a force
// (Bridson, Fedkiw and Anderson 2002). A new one adds its include and its VELOCITY_FILTER line here. Like a term it has
// lists of parameters and fields, and it is active if one of its STRENGTH parameters is not zero.
//     VELOCITY_FILTER(name, item kind)     kernel: name_apply(item, dt, args)
#pragma once
#include "velocity_filters/velocity_rule.h"

#define VELOCITY_FILTERS(VELOCITY_FILTER) VELOCITY_FILTER(velocity_rule, vertex)
