// The list of rules. A rule changes positions and velocities directly after a step instead of adding a force, like a
// velocity filter. A new rule adds its include and its RULE line here. Like a term, a rule has lists of parameters and
// fields, and it is active if one of its STRENGTH parameters is not zero.
//     RULE(name, item kind)     kernel: name_apply(item, dt, args)
#pragma once
#include "rules/velocity_rule.h"

#define RULES(RULE) RULE(velocity_rule, vertex)
