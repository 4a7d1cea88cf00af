// The exponential repulsion q(s) and its integral Q. s is the gap divided by the gap at which contact sets in.
//     s >= 1:        q = 0
//     s0 < s < 1:    q = exp(1/s) - e,    Q = integral of q from s to 1 = Ei(1/s) - Ei(1) - s exp(1/s) + e s
//     s <= s0:       q = q(s0), with s0 = 0.1, so that the force is bounded, also for a vertex inside a body
// Source: Fan, Zhou, Wang and Yuen 1998, f_r = c_r exp(1/delta) for delta <= d, with three corrections. The printed law
// jumps to c_r exp(1/d) at delta = d; the shift by -e removes the jump. It overflows as delta goes to 0 and attracts
// for delta < 0; the cap at q(s0) = exp(10) - e removes both. Its exponent 1/delta is not dimensionless; here delta is
// divided by d. s0 was chosen by hand; not measured.
#pragma once
#include "barrier.h"

// Ei(u) - Ei(1) for u in [1, 10] by the series ln u + sum of (u^k - 1) / (k k!). All its terms are positive, so nothing
// cancels, and at u = 10 the first term left out, k = 61, is below 1e-24.
KERNEL_FN real exponential_integral_from_one(real u)
{
    real term = REAL(1), of_one = REAL(1), sum = log(u);  // u^k / k! and 1 / k!
    for (int k = 1; k <= 60; ++k) {
        term *= u / (real)k;
        of_one /= (real)k;
        sum += (term - of_one) / (real)k;
    }
    return sum;
}

// Value Q, slope -q and curvature -dq/ds.
KERNEL_FN barrier_jet repulsion_at(real s)
{
    const real s0 = REAL(0.1), e = REAL(2.718281828459045235);
    barrier_jet b;
    b.value = b.slope = b.curvature = REAL(0);
    if (s >= REAL(1)) return b;
    real t = larger(s, s0), u = REAL(1) / t, grown = exp(u);
    b.value = exponential_integral_from_one(u) - t * grown + e * t;
    b.slope = e - grown;
    b.curvature = u * u * grown;
    if (s > s0) return b;
    b.value += (s - s0) * b.slope;
    b.curvature = REAL(0);
    return b;
}
