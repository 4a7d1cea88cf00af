// The list of rules: what changes the state after a step without being a force. A new rule adds its include and its
// RULE line here. Like terms they have lists of parameters and fields, and are active if a STRENGTH is not zero.
//     RULE(name, item kind)     kernel: name_apply(item, dt, args)
#pragma once
#include "rules/velocity_rule.h"

#define RULES(RULE) RULE(velocity_rule, vertex)
