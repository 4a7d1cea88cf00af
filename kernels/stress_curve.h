// A stress-strain curve that is a cubic polynomial on each of its ranges, and its exact integral.
//     range p, start_p <= e < start_(p+1),  d = e - start_p:
//         s = s_p + a d + b d^2 + c d^3,      W = W_p + s_p d + a d^2/2 + b d^3/3 + c d^4/4,      t = ds/de
// The first range starts at e = 0 with s = W = 0. In compression, e < 0, the curve is s = a e. The last range has no
// end. Unused ranges start beyond any strain.
// Source: both the piecewise linear curves that Fan, Zhou, Wang and Yuen 1998 take from Kawabata's instruments and the
// polynomials of Volino, Magnenat-Thalmann and Faure 2009, section 4, have this form.
#pragma once
#include "portable.h"

#define CURVE_RANGES 10
#define CURVE_NUMBERS 6  // of a range: start, W_p, s_p, a, b, c

typedef struct {
    real energy, stress, tangent;
} curve_value;

// Evaluates a curve. Number k of range p is curve[(CURVE_NUMBERS * p + k) * stride].
KERNEL_FN curve_value curve_at(GLOBAL const real* curve, int stride, real strain)
{
    int range = 0;
    while (range + 1 < CURVE_RANGES && strain >= curve[CURVE_NUMBERS * (range + 1) * stride]) ++range;
    GLOBAL const real* k = curve + CURVE_NUMBERS * range * stride;
    real d = strain - k[0], up = larger(d, REAL(0));
    real a = k[3 * stride], b = k[4 * stride], c = k[5 * stride];
    curve_value value;
    value.energy =
        k[stride] + d * (k[2 * stride] + REAL(0.5) * a * d) + up * up * up * (b / REAL(3) + REAL(0.25) * c * up);
    value.stress = k[2 * stride] + a * d + up * up * (b + c * up);
    value.tangent = a + up * (REAL(2) * b + REAL(3) * c * up);
    return value;
}

// Evaluates the odd continuation of a curve, s(-e) = -s(e), which shear needs.
KERNEL_FN curve_value odd_curve_at(GLOBAL const real* curve, int stride, real strain)
{
    curve_value value = curve_at(curve, stride, fabs(strain));
    if (strain < REAL(0)) value.stress = -value.stress;
    return value;
}
