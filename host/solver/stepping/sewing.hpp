#pragma once
#include <memory>
#include <vector>

#include "host/solver/stepping/step_control.hpp"

namespace selvage {

struct SewingOptions {
    double step = 0.02;              ///< [s]
    double closed = 0.002;           ///< Gap below which a pair is welded [m].
    double energy_tolerance = 1e-4;  ///< Relative change of elastic energy between steps at which sewing may end [1].
    double max_time = 20;            ///< After which seams that are still open are given up [s].
    double first_stiffness = 0;      ///< Seam stiffness at the start of sewing [N/m].
    double first_limit = 0;          ///< Seam force limit then [N].
    double edge_length = 0.02;       ///< Of a typical edge [m].
    double thin = 0;                 ///< Part of their thickness by which bodies can be thin meanwhile [1].
    bool thin_at_once = false;       ///< They are from the start; else only if seams do not close on the whole ones.
};

/// Where sewing stands; kept in checkpoints.
struct SewingProgress {
    std::vector<char> welded;   ///< Per pair of Cloth::seam_pairs: it is one particle; empty: nothing is sewn yet.
    int steps_since_look = 0;   ///< Steps since pairs were last looked at.
    int harder = 0;             ///< How many times seams are pulled harder than at first.
    int looks_in_vain = 0;      ///< Looks one after the other at the hardest pull that found no headway.
    double open_way = 1e30;     ///< Sum of all gaps at the last look [m].
    bool on_thin = false;       ///< Bodies are thin.
    double grows_from = -1;     ///< When bodies began to grow back [s]; below 0: seams are being closed.
    int failures = 0;           ///< Steps that did not succeed at any length.
    int settled_steps = 0;      ///< Steps since bodies have their size.
    double elastic_energy = 0;  ///< After the last step [J].
    double energy_change = 1;   ///< Relative, of the last step [1].
    StepMemory steps = {};
};

/// Where pressing stands; kept in checkpoints.
struct PressProgress {
    int step = 0;
    StepMemory steps = {};
};

/// A cloth while it is sewn: what its phase is made of, which is made anew whenever pairs are welded.
struct SewnCloth {
    const ClothModel& model;
    PhaseOptions options;
    BodyQuery* query;
    Profile& profile;
    std::unique_ptr<Phase>& phase;
    std::function<void()> remade = [] {};  ///< Called whenever the phase is another one.
    /// Asked within steps: true gives up the one at hand and stops.
    std::function<bool()> stop = [] { return false; };
};

/// Returns the largest distance of a stitched pair [m], 0 without stitches.
double largest_gap(const Phase& phase);

/// Which pairs of a cloth start at one place: they are sewn before the first step.
std::vector<char> coinciding_pairs(const Cloth& cloth);

/// Returns the largest force with which a pair is pulled now [N].
double pull_limit(const SewingOptions& options, const SewingProgress& progress);

/// Makes contact stiff enough for seams that are pulled, or for the cloth that they have closed: a tension t [N/m] over
/// an edge as long as a triangle's, h, presses with t / h, and no vertex may be pressed to where its barrier does not
/// resist any more. @param pull  t h [N]   @param edge_length  h [m]
void bear_pull(Params& params, double pull, double edge_length);

/// True if no pair is left to weld.
bool all_welded(const std::vector<char>& welded);

/// Makes the phase anew, with what progress says is welded and at its pull. What is at one place becomes one particle,
/// which keeps mass and momentum. @param positions  per cloth vertex [m]   @param clock  goes on
void remake_phase(SewnCloth& cloth, const SewingOptions& options, const SewingProgress& progress,
                  const std::vector<Vec3>& positions, const std::vector<Vec3>& velocities, Clock clock);

/// Draws the panels together: springs, seam force, damping and contact, no gravity. Every few steps the pairs that have
/// come close are welded; where none has and the gaps do not shrink, seams are pulled harder.
/// @returns reached: all are welded; time_limit: the others have been given up
PhaseEnd close_seams(SewnCloth& cloth, const SewingOptions& options, SewingProgress& progress,
                     const AfterStep& after_step);

/// Goes on while bodies move by themselves to what they are without sewing, and until the cloth has settled on them.
/// Seams that are open still are pulled and welded.
/// @returns reached; stopped; time_limit: cloth is in the way of the bodies
PhaseEnd let_bodies_grow(SewnCloth& cloth, const SewingOptions& options, SewingProgress& progress,
                         const AfterStep& after_step);

/// Presses the seams of a garment that has just been joined: a few steps without gravity and friction in which the
/// cloth resists bending many times more than it will. Laps that sewing left at a seam fold open.
PhaseEnd press_seams(Phase& phase, double step, PressProgress& progress, const AfterStep& after_step);

}  // namespace selvage
