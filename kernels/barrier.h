// The barrier b(s) that keeps surfaces apart; s is a gap over the one at which contact sets in.
//     s >= 1:        b = 0
//     s0 < s < 1:    b = -(s - 1)^2 ln s
//     -1 < s <= s0:  the second-order continuation of b at s0 = 0.02
//     s <= -1:       its tangent: a vertex that starts deep inside is pushed out with a bounded force
// Source: Li and others 2020, eq. 6, continued so that cloth that starts inside a body has a finite force.
#pragma once
#include "portable.h"

typedef struct {
    real value, slope, curvature;
} barrier_jet;

KERNEL_FN barrier_jet log_barrier(real s)
{
    real u = s - REAL(1), l = log(s);
    barrier_jet b;
    b.value = -u * u * l;
    b.slope = REAL(-2) * u * l - u * u / s;
    b.curvature = REAL(-2) * l - REAL(4) * u / s + u * u / (s * s);
    return b;
}

KERNEL_FN barrier_jet barrier_at(real s)
{
    const real s0 = REAL(0.02);
    barrier_jet b;
    b.value = b.slope = b.curvature = REAL(0);
    if (s >= REAL(1)) return b;
    b = log_barrier(larger(s, s0));
    if (s >= s0) return b;
    real d = larger(s, REAL(-1)) - s0;
    b.value += d * (b.slope + REAL(0.5) * d * b.curvature);
    b.slope += d * b.curvature;
    if (s > REAL(-1)) return b;
    b.value += (s + REAL(1)) * b.slope;
    b.curvature = REAL(0);
    return b;
}

// The barrier of pairs, which never touch: without the continuation no force gets the better of it.
KERNEL_FN barrier_jet open_barrier_at(real s)
{
    barrier_jet b;
    b.value = b.slope = b.curvature = REAL(0);
    return s >= REAL(1) ? b : log_barrier(larger(s, REAL(1e-9)));
}
