// The list of force terms. A new term adds its include and its TERM line here, and nothing elsewhere.
//     TERM(name, item kind, nature)    conservative: the value is an energy [J];
//                                      dissipative: it is a dissipation potential R(v) [W], force = -dR/dv
#pragma once
#include "terms/bending.h"
#include "terms/body_contact.h"
#include "terms/curved_membrane.h"
#include "terms/damping.h"
#include "terms/friction.h"
#include "terms/gravity.h"
#include "terms/membrane.h"
#include "terms/seam.h"
#include "terms/spring.h"

#define TERMS(TERM)                             \
    TERM(gravity, vertex, conservative)         \
    TERM(membrane, face, conservative)          \
    TERM(curved_membrane, face, conservative)   \
    TERM(spring, spring, conservative)          \
    TERM(bending, hinge, conservative)          \
    TERM(seam, stitch, conservative)            \
    TERM(damping, vertex, dissipative)          \
    TERM(body_contact, vertex, conservative)    \
    TERM(friction, vertex, conservative)
