// The list of force terms. A new term adds its include and its TERM line here, and nothing elsewhere.
//     TERM(name, item kind, nature, stage)
//         nature  conservative: the value is an energy [J];
//                 dissipative: it is a dissipation potential R(v) [W], force = -dR/dv
//         stage   kernel that is launched over the term's items before each of its functions, or no_stage
#pragma once
#include "terms/bending.h"
#include "terms/bending_hysteresis.h"
#include "terms/body_contact.h"
#include "terms/body_repulsion.h"
#include "terms/cloth_contact.h"
#include "terms/cloth_friction.h"
#include "terms/cloth_repulsion.h"
#include "terms/curved_membrane.h"
#include "terms/damping.h"
#include "terms/friction.h"
#include "terms/gravity.h"
#include "terms/membrane.h"
#include "terms/plate.h"
#include "terms/seam.h"
#include "terms/spring.h"

#define TERMS(TERM)                                            \
    TERM(gravity, vertex, conservative, no_stage)              \
    TERM(membrane, face, conservative, no_stage)               \
    TERM(curved_membrane, face, conservative, no_stage)        \
    TERM(spring, spring, conservative, no_stage)               \
    TERM(bending, hinge, conservative, no_stage)               \
    TERM(plate, hinge, conservative, plate_turns)              \
    TERM(bending_hysteresis, hinge, conservative, no_stage)    \
    TERM(seam, stitch, conservative, no_stage)                 \
    TERM(damping, vertex, dissipative, no_stage)               \
    TERM(body_contact, vertex, conservative, no_stage)         \
    TERM(body_repulsion, vertex, conservative, no_stage)       \
    TERM(friction, vertex, conservative, no_stage)             \
    TERM(cloth_contact, pair, conservative, pair_frame)        \
    TERM(cloth_repulsion, pair, conservative, repulsion_frame) \
    TERM(cloth_friction, pair, conservative, no_stage)
