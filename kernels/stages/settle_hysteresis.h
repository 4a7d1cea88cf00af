// Updates the anchor of a hinge's friction moment at the end of a step: a slipping hinge drags its anchor at the
// distance r, the largest elastic turn.
//     anchor = phi - w min(1, r / |w|),   w = phi - anchor
// Source: see terms/bending_hysteresis.h.
#pragma once
#include "../terms/bending_hysteresis.h"

#define settle_hysteresis_FIELDS(READ, ADD) ADD(hinge_anchor)

typedef struct {
    bending_hysteresis_args hysteresis;
    settle_hysteresis_FIELDS(ARG_READ, ARG_ADD)
} settle_hysteresis_args;

KERNEL_FN void settle_hysteresis_hinge(int hinge, const settle_hysteresis_args* a)
{
    const bending_hysteresis_args* term = &a->hysteresis;
    hinge_state h = hinge_at(hinge, term->size, term->pos, term->hinge_vertex);
    real w = bending_hysteresis_turn(hinge, &h, term), r = term->stick_curvature * term->hinge_width[hinge];
    if (fabs(w) > r) a->hinge_anchor[hinge] += w < REAL(0) ? w + r : w - r;
}
