#pragma once
#include "host/solver/stepping/step_control.hpp"

namespace selvage {

struct SewingOptions {
    double step = 0.02;              ///< [s]
    double closed = 0.002;           ///< Gap below which a pair counts as closed [m].
    double energy_tolerance = 1e-4;  ///< Relative change of elastic energy between steps at which sewing may end [1].
    double max_time = 6;             ///< [s]
    double first_stiffness = 0;      ///< Seam stiffness at the start of sewing [N/m].
};

/// Where a sewing phase stands; kept in checkpoints.
struct SewingProgress {
    double best_gap = 1e30;  ///< Smallest value of the largest gap so far [m].
    int steps_without_gain = 0;
    double elastic_energy = 0;  ///< After the last step [J].
    double gap = 1e30;          ///< Largest gap after the last step [m].
    double energy_change = 1;   ///< Relative, of the last step [1].
    StepMemory steps = {};
};

/// Where pressing stands; kept in checkpoints.
struct PressProgress {
    int step = 0;
    StepMemory steps = {};
};

/// Returns the largest distance of a stitched pair [m], 0 without stitches.
double largest_gap(const Phase& phase);

/// Draws the panels together: springs, seam force, damping and contact, no gravity, until every pair is
/// closer than `closed` and the elastic energy has settled. A seam that makes no headway is pulled harder.
PhaseEnd sew(Phase& phase, const SewingOptions& options, SewingProgress& progress, const AfterStep& after_step);

/// Presses the seams of a garment that has just been joined: a few steps without gravity and friction in which the
/// cloth resists bending many times more than it will. Laps that sewing left at a seam fold open.
PhaseEnd press_seams(Phase& phase, double step, PressProgress& progress, const AfterStep& after_step);

}  // namespace selvage
