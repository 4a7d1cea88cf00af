#include "host/mannequin/mannequin_figure.hpp"

#include <algorithm>

namespace selvage {
namespace {

// Torso stations: {height, 0, y of the centre, half width, depth to the front,
// depth to the back}, shares of bust, waist and hips.
const FigureDrawing women{
    .bust = 0.92,
    .hips = 1.00,
    .shoulder_width = 0.34,
    .torso = {{{0.795, 0, 0.016, 0.095, 0.054, 0.072}, 0, 0, 0.53},
              {{0.835, 0, 0.012, 0.150, 0.090, 0.097}, 0, 0, 0.87},
              {{0.875, 0, 0.009, 0.161, 0.104, 0.110}, 0, 0, 1},
              {{0.930, 0, 0.006, 0.159, 0.108, 0.103}, 0, 0.1, 0.9},
              {{1.000, 0, 0.002, 0.143, 0.106, 0.087}, 0, 0.72, 0.28},
              {{1.065, 0, 0.000, 0.121, 0.099, 0.083}, 0, 1, 0},
              {{1.120, 0, 0.004, 0.126, 0.101, 0.093}, 0.28, 0.72, 0},
              {{1.175, 0, 0.011, 0.137, 0.102, 0.105}, 0.75, 0.25, 0},
              {{1.215, 0, 0.016, 0.145, 0.102, 0.111}, 0.94, 0, 0},
              {{1.270, 0, 0.021, 0.157, 0.092, 0.110}, 0.92, 0, 0},
              {{1.320, 0, 0.025, 0.152, 0.078, 0.100}, 0.84, 0, 0},
              {{1.365, 0, 0.027, 0.118, 0.064, 0.080}, 0.68, 0, 0}},
    .chest = {{0.078, -0.070, 1.216}, {0.060, 0.056, 0.064}, 0.055},
    .shoulder_blade = {{0.078, 0.092, 1.275}, {0.050, 0.040, 0.080}, 0.050},
    .seat = {{0.074, 0.056, 0.870}, {0.080, 0.076, 0.095}, 0.050},
};

const FigureDrawing men{
    .bust = 0.96,
    .hips = 0.98,
    .shoulder_width = 0.385,
    .torso = {{{0.795, 0, 0.012, 0.090, 0.058, 0.068}, 0, 0, 0.53},
              {{0.835, 0, 0.010, 0.140, 0.090, 0.094}, 0, 0, 0.88},
              {{0.875, 0, 0.008, 0.150, 0.104, 0.104}, 0, 0, 1},
              {{0.940, 0, 0.006, 0.149, 0.109, 0.099}, 0, 0.15, 0.85},
              {{1.000, 0, 0.004, 0.147, 0.110, 0.092}, 0, 0.70, 0.30},
              {{1.065, 0, 0.004, 0.142, 0.106, 0.090}, 0, 1, 0},
              {{1.120, 0, 0.008, 0.147, 0.104, 0.099}, 0.25, 0.75, 0},
              {{1.175, 0, 0.013, 0.156, 0.104, 0.109}, 0.70, 0.30, 0},
              {{1.225, 0, 0.017, 0.163, 0.103, 0.115}, 0.95, 0, 0},
              {{1.275, 0, 0.021, 0.177, 0.096, 0.114}, 0.95, 0, 0},
              {{1.320, 0, 0.024, 0.170, 0.082, 0.104}, 0.86, 0, 0},
              {{1.365, 0, 0.026, 0.128, 0.066, 0.084}, 0.69, 0, 0}},
    .chest = {{0.082, -0.052, 1.262}, {0.082, 0.046, 0.062}, 0.075},
    .shoulder_blade = {{0.086, 0.094, 1.270}, {0.056, 0.042, 0.085}, 0.050},
    .seat = {{0.068, 0.050, 0.868}, {0.074, 0.072, 0.088}, 0.050},
    .upper_arm = 1.06,
    .wrist = 1.06,
    .hand = 1.05,
    .foot = 1.06,
    .shoulder = 1.10,
    .bust_height = 1.2525,
};

const FigureDrawing children{
    .bust = 0.92,
    .hips = 0.98,
    .shoulder_width = 0.364,
    .torso = {{{0.795, 0, 0.012, 0.090, 0.058, 0.068}, 0, 0, 0.55},
              {{0.835, 0, 0.010, 0.140, 0.090, 0.092}, 0, 0, 0.89},
              {{0.875, 0, 0.008, 0.150, 0.107, 0.104}, 0, 0, 1},
              {{0.940, 0, 0.004, 0.148, 0.113, 0.098}, 0, 0.20, 0.80},
              {{1.000, 0, 0.000, 0.145, 0.116, 0.089}, 0, 0.75, 0.25},
              {{1.065, 0, -0.001, 0.138, 0.113, 0.085}, 0, 1, 0},
              {{1.120, 0, 0.004, 0.139, 0.106, 0.095}, 0.35, 0.65, 0},
              {{1.175, 0, 0.010, 0.142, 0.102, 0.106}, 0.80, 0.20, 0},
              {{1.225, 0, 0.015, 0.145, 0.100, 0.111}, 0.97, 0, 0},
              {{1.275, 0, 0.019, 0.155, 0.093, 0.109}, 0.95, 0, 0},
              {{1.320, 0, 0.023, 0.150, 0.080, 0.100}, 0.87, 0, 0},
              {{1.365, 0, 0.026, 0.116, 0.066, 0.080}, 0.70, 0, 0}},
    .chest = {{0.070, -0.048, 1.250}, {0.070, 0.040, 0.060}, 0.075},
    .shoulder_blade = {{0.076, 0.088, 1.275}, {0.050, 0.040, 0.080}, 0.050},
    .seat = {{0.066, 0.052, 0.868}, {0.072, 0.072, 0.086}, 0.050},
    .arm_growth = 1.05,
    .foot = 1.08,
    .bust_height = 1.230,
};

// Heights of crotch, waist, bust, shoulder joint, the neck's root, chin and
// crown in the drawing, and over the stature for a child of 1.10 m.
constexpr std::array<double, 8> knots{0, 0.785, 1.065, 1.215, 1.350, 1.415, 1.476, 1.70};
constexpr std::array<double, 8> child_knots{0, 0.437, 0.603, 0.702, 0.780, 0.806, 0.842, 1};
constexpr double child_stature = 1.10, adult_stature = 1.62;

}  // namespace

const FigureDrawing& drawing_of(BodyFigure figure)
{
    if (figure == BodyFigure::men) return men;
    return figure == BodyFigure::children ? children : women;
}

HeightScale::HeightScale(BodyFigure figure, double stature)
{
    if (figure == BodyFigure::children)
        youth_ = std::clamp((adult_stature - stature) / (adult_stature - child_stature), 0.0, 1.0);
    for (int k = 0; k < knot_count; ++k)
        heights_[k] = stature * ((1 - youth_) * knots[k] / knots.back() + youth_ * child_knots[k]);
}

double HeightScale::operator()(double drawn) const
{
    int k = 0;
    while (k + 2 < knot_count && drawn > knots[k + 1]) ++k;
    return heights_[k] + (drawn - knots[k]) / (knots[k + 1] - knots[k]) * (heights_[k + 1] - heights_[k]);
}

}  // namespace selvage
