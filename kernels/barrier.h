// The logarithmic barrier b(s) of incremental potential contact. s is the gap divided by the gap at which contact sets
// in, the d_hat of the source.
//     s >= 1:        b = 0
//     s0 < s < 1:    b = -(s - 1)^2 ln s
//     -1 < s <= s0:  the second-order Taylor polynomial of b at s0 = 0.02
//     s <= -1:       the tangent of that polynomial at s = -1, so that the force on a vertex deep inside is bounded
// Source: Li and others 2020, eq. 6. The continuation below s0 gives cloth that starts inside a body a finite force.
// s0 was chosen by hand; not measured.
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

// The barrier for pairs of primitives, without the continuation: it grows without bound as s goes to 0, so no force can
// close the gap. The CCD filter keeps s positive; the floor at 1e-9 only keeps the logarithm finite.
KERNEL_FN barrier_jet open_barrier_at(real s)
{
    barrier_jet b;
    b.value = b.slope = b.curvature = REAL(0);
    return s >= REAL(1) ? b : log_barrier(larger(s, REAL(1e-9)));
}
