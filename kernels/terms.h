// The list of force terms. A new term adds its include and its TERM line here, and nothing elsewhere.
//     TERM(name, item kind, nature, stage, family)
//         nature  conservative: the value is an energy [J];
//                 dissipative: it is a dissipation potential R(v) [W], force = -dR/dv
//         stage   kernel that is launched over the term's items before each of its functions, or no_stage
//         family  what its energy is reported with, one of EnergyFamily in host/solver/terms/energy_family.hpp
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
#include "terms/wind.h"

#define TERMS(TERM)                                                     \
    TERM(gravity, vertex, conservative, no_stage, external)             \
    TERM(membrane, face, conservative, no_stage, membrane)              \
    TERM(curved_membrane, face, conservative, no_stage, membrane)       \
    TERM(spring, spring, conservative, no_stage, membrane)              \
    TERM(bending, hinge, conservative, no_stage, bending)               \
    TERM(plate, hinge, conservative, plate_turns, bending)              \
    TERM(bending_hysteresis, hinge, conservative, no_stage, bending)    \
    TERM(seam, stitch, conservative, no_stage, seam)                    \
    TERM(damping, vertex, dissipative, no_stage, damping)               \
    TERM(wind, vertex, conservative, no_stage, air)                     \
    TERM(air_drag, vertex, dissipative, no_stage, air)                  \
    TERM(body_contact, vertex, conservative, no_stage, contact)         \
    TERM(body_repulsion, vertex, conservative, no_stage, contact)       \
    TERM(friction, vertex, conservative, no_stage, friction)            \
    TERM(cloth_contact, pair, conservative, pair_frame, contact)        \
    TERM(cloth_repulsion, pair, conservative, repulsion_frame, contact) \
    TERM(cloth_friction, pair, conservative, no_stage, friction)
