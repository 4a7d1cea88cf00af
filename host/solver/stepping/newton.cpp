#include "host/solver/stepping/newton.hpp"

#include <algorithm>
#include <cmath>

#include "host/parallel/launch.hpp"
#include "host/solver/state/vectors.hpp"
#include "kernels/curve_way.h"
#include "kernels/stages/newton_steps.h"

namespace selvage {
namespace {

constexpr double almost = 10;           // times what would count as converged: a direction that gains no more may fail
constexpr double promise_noise = 1e-9;  // part of the objective that a direction may promise wrongly by rounding
constexpr double follow_tolerance = 0.1;  // relative residual of the solve that lets the cloth follow the pins
constexpr int follow_iterations = 60;     // of that solve: it only leads the cloth on, and in a jam it converges badly
// Where a step is to be solved. Each was varied on pendulums of 1e2 to 1e7 N/m; `validate motion` shows what they
// leave.
constexpr double solve_part = 0.05;        // error of the linear solves in the energy norm, over the solution's
constexpr double solve_left = 1e-3;        // or their squared error, over what may be left of the step
constexpr double curve_part = 0.1;         // error of the solve that bends a way, as solve_part
constexpr double worth_bending = 0.3;      // energy of the stretch of second order over what a direction promises
constexpr int straight_attempts = 3;       // halvings of a bent way before it is given up
constexpr int iterations_per_advance = 3;  // of bodies and pins: the cloth needs some to make way for the next advance
constexpr int most_waiting_iterations = 60 * iterations_per_advance;  // while bodies and pins are not at their goal

// What is minimised; see Newton.
struct Objective {
    double span = 0;     // h [s]; 0: the static energy
    double inertia = 0;  // 1/h^2; 0 for the static energy [1/s^2]
    const std::vector<real>& origin;
    const std::vector<real>& target;  // without a meaning for the static energy
};

// One minimisation.
class Minimisation {
public:
    Minimisation(System& system, LinearSolver& linear, Newton::Vectors& vectors, const Objective& objective,
                 const NewtonOptions& options)
        : system_(system), state_(system.state()), linear_(linear), objective_(objective), options_(options),
          start_(vectors.start), base_(vectors.base), downhill_(vectors.downhill), direction_(vectors.direction),
          unlimited_(vectors.unlimited), straight_(vectors.straight), curve_(vectors.curve)
    {
        for (std::vector<real>* v : {&downhill_, &direction_}) v->resize(state_.pos.size());
        if (!is_solved()) return;
        const double speed = options.acceleration_left * objective.span;
        free_mass_ = free_mass(state_);
        energy_allowed_ = free_mass_ * speed * speed;
    }

    void guess(const std::vector<real>* expected);
    NewtonReport iterate(bool settles);

private:
    bool is_static() const { return objective_.inertia == 0; }
    bool is_solved() const { return options_.acceleration_left > 0 && !is_static(); }
    bool swings_freely() const;
    newton_descent_args descent() const;
    newton_move_args movement(double fraction) const;
    double value() const;
    void evaluate_gradient();
    void assemble(bool projected);
    LinearGoal goal() const;
    double search_direction();
    void bend_way();
    void aim(double part);
    double halve_bent_way(int attempt);
    bool search_line(double slope);
    void move_along_direction(double fraction);
    void return_to_base();
    void go_to(const std::vector<real>& place);
    void follow_pins(std::vector<real>& move);
    bool advance_boundary();
    bool moves_little() const;
    double as_acceleration(double energy) const;
    double acceleration_of_forces() const;
    bool almost_converged() const;

    System& system_;
    State& state_;
    LinearSolver& linear_;
    const Objective objective_;
    const NewtonOptions& options_;
    NewtonReport report_;
    double promised_ = 0;        // decrease of the objective along the last direction, before it was limited [J]
    double wanted_move_ = 0;     // largest displacement of that direction [m]
    double free_mass_ = 0;       // [kg], where the step is to be solved
    double energy_allowed_ = 0;  // squared norm of what may be left of the step [J]
    double energy_left_ = 0;     // of the last direction's linear solve [J]
    bool assembled_ = false;     // the linear solver has a matrix of this minimisation
    bool bent_ = false;          // the way is s straight + s^2 curve; otherwise it is s direction
    std::vector<real>&start_, &base_, &downhill_, &direction_, &unlimited_, &straight_, &curve_;
};

// Whether no body and no cloth is near. Where they cut a bent way short, short steps towards rest failed, and a garment
// was led off the bar that it was to hang on.
bool Minimisation::swings_freely() const
{
    const ClothContact* contact = system_.cloth_contact();
    return !system_.bodies_exert_forces() && !(contact && contact->has_candidates());
}

newton_descent_args Minimisation::descent() const
{
    return {state_.pos.data(),      state_.force.data(), objective_.target.data(), state_.mass.data(),
            state_.inv_mass.data(), downhill_.data(),    objective_.inertia,       state_.size.vertex_stride};
}

newton_move_args Minimisation::movement(double fraction) const
{
    return {state_.pos.data(),        state_.vel.data(),      base_.data(), direction_.data(),
            objective_.origin.data(), state_.inv_mass.data(), fraction,     is_static() ? 0 : 1 / objective_.span,
            state_.size.vertex_stride};
}

double Minimisation::value() const
{
    double total = system_.awake_energy();
    if (is_static()) return total;
    total += objective_.span * system_.dissipation();
    return total + 0.5 * objective_.inertia * launch_sum<newton_inertia>(Items{state_.size.vertex_count}, descent());
}

// downhill = f - m (x - target) / h^2, zero at vertices that are pinned or asleep.
void Minimisation::evaluate_gradient()
{
    if (is_static()) {
        downhill_ = system_.static_force();
        return;
    }
    system_.evaluate_forces(true);
    if (!state_.awake.all) clear(downhill_);
    launch<newton_descent>(items_of(state_, ItemKind::vertex), descent());
}

void Minimisation::assemble(bool projected)
{
    // d2/dx2 of h R(v) is 1/h of d2R/dv2.
    system_.evaluate_stiffness(projected, is_static() ? 0 : 1 / objective_.span);
    // Stiff cloth that has turned meets older coarse matrices as if its turning were stretch, and the estimate of what
    // a solve has left is fooled: 1e7 N/m swung 10 % too fast, however little the turn.
    const bool likewise = assembled_ && !is_solved();
    system_.profile().timed("assemble", state_.size.vertex_count, 0, [&] {
        linear_.assemble(state_, objective_.inertia, likewise ? MatrixUse::likewise : MatrixUse::solves);
    });
    assembled_ = true;
}

LinearGoal Minimisation::goal() const
{
    if (!is_solved()) return {.residual = options_.linear_tolerance};
    return {.energy_part = solve_part, .energy_left = solve_left * energy_allowed_};
}

// Solves for the direction and limits it; returns the slope of the objective along it (negative).
double Minimisation::search_direction()
{
    assemble(!options_.full_stiffness);
    const LinearResult result = system_.profile().timed("linear_solve", state_.size.vertex_count, 0, [&] {
        return linear_.solve(downhill_.data(), goal(), direction_.data());
    });
    report_.linear_iterations += result.iterations;
    energy_left_ = result.energy_left;
    report_.negative_curvature += result.negative_curvature;
    report_.indefinite += result.negative_curvature && result.iterations == 0;
    if (dot(state_, downhill_, direction_) < 0)  // only an indefinite matrix can give this
        scale(direction_, -1);
    promised_ = dot(state_, downhill_, direction_);
    wanted_move_ = largest_move(state_, direction_);
    bent_ = false;
    if (is_solved() || (!is_static() && swings_freely())) bend_way();
    if (bent_)
        aim(1);
    else if (!system_.bodies_exert_forces() && !system_.cloth_contact())
        return -promised_;
    else
        limit_descent(system_, options_.move_limits, downhill_, direction_, unlimited_);
    return -dot(state_, downhill_, direction_);
}

// Finds the curve that undoes the stretch of second order along the direction, where that stretch would outweigh what
// the direction gains.
void Minimisation::bend_way()
{
    const double energy = system_.second_order_stretch(direction_);
    if (energy <= worth_bending * promised_) return;
    straight_ = direction_;
    curve_.resize(straight_.size());
    clear_resting(state_, state_.force);
    report_.linear_iterations +=
        linear_.solve(state_.force.data(), {.energy_part = curve_part}, curve_.data()).iterations;
    ++report_.bent;
    bent_ = true;
}

// Takes the bent way up to a part of it as the direction, within its limits.
void Minimisation::aim(double part)
{
    launch<part_of_way>(int(direction_.size()),
                        part_of_way_args{direction_.data(), straight_.data(), curve_.data(), part});
    if (system_.bodies_exert_forces() || system_.cloth_contact())
        limit_descent(system_, options_.move_limits, downhill_, direction_, unlimited_);
}

// The chord of a part of a bent way is another direction than that of the whole.
// @returns the fraction of it that the limits allow
double Minimisation::halve_bent_way(int attempt)
{
    return_to_base();
    evaluate_gradient();
    if (attempt == straight_attempts) {
        bent_ = false;
        clear(curve_);
    }
    aim(std::ldexp(1.0, -attempt - 1));
    return longest_fraction(system_, options_.move_limits, direction_);
}

// x = base + fraction * direction, v = (x - origin) / h
void Minimisation::move_along_direction(double fraction)
{
    launch<newton_move>(state_.size.vertex_count, movement(fraction));
}

void Minimisation::return_to_base() { launch<newton_return>(state_.size.vertex_count, movement(0)); }

// Moves from the start towards a place, as far as contacts let the vertices come.
void Minimisation::go_to(const std::vector<real>& place)
{
    return_to_base();
    free_difference(state_, direction_, place, start_);
    limit_guess(system_, options_.move_limits, direction_);
    move_along_direction(longest_fraction(system_, options_.move_limits, direction_));
}

// Starts from where the cloth is, from where it would fly without forces, or from what its motion so far lets expect:
// whichever has the lowest objective. A step that is to be solved starts from what is expected: a little stretch there
// weighs more than all of the way, but is the first thing that an iteration takes off.
void Minimisation::guess(const std::vector<real>* expected)
{
    start_ = state_.pos;
    base_ = start_;
    if (system_.bodies_exert_forces()) system_.refresh_planes();
    system_.refresh_air();
    if (is_solved() && expected) {
        go_to(*expected);
        if (std::isfinite(value())) return;
        return_to_base();
    }
    const std::vector<real>*best = &start_, *reached = &start_;
    double lowest = value();
    for (const std::vector<real>* candidate : {expected, &objective_.target}) {
        if (!candidate) continue;
        // Checking a way through cloth takes long: where cloth is near itself, one must do.
        if (reached != &start_ && system_.cloth_contact() && system_.cloth_contact()->has_candidates()) break;
        go_to(*candidate);
        reached = candidate;
        const double there = value();
        if (!(there < lowest)) continue;
        lowest = there;
        best = candidate;
    }
    if (best == &start_)
        return_to_base();
    else if (best != reached)
        go_to(*best);
}

// Backtracks until the objective falls by a fraction of what the slope promises. Below the rounding noise of the
// objective the slope itself decides: a direction that still points downhill has not gone too far.
bool Minimisation::search_line(double slope)
{
    base_ = state_.pos;
    const double before = value();
    double fraction = longest_fraction(system_, options_.move_limits, direction_), part = 1;
    const double noise = 1e-13 * std::abs(before) + 1e-16;
    for (int attempt = 0; attempt < 16; ++attempt) {
        move_along_direction(fraction);
        const double after = value();
        if (std::isfinite(after) && after <= before + 1e-4 * part * fraction * slope) return true;
        if (std::isfinite(after) && std::abs(after - before) <= noise) {
            evaluate_gradient();
            if (std::abs(dot(state_, downhill_, direction_)) <= 0.9 * std::abs(slope)) return true;
        }
        if (bent_) {
            fraction = halve_bent_way(attempt);
            part *= 0.5;
        } else {
            fraction *= 0.5;
        }
    }
    return_to_base();
    return false;
}

// The first-order answer of the free vertices to moves u of pinned ones: K_ff d = -K_fp u.
void Minimisation::follow_pins(std::vector<real>& move)
{
    if (!assembled_) assemble(true);
    linear_.multiply(move.data(), downhill_.data());
    free_negative(state_, downhill_, downhill_);
    linear_.solve(downhill_.data(), {.residual = follow_tolerance, .at_most = follow_iterations}, direction_.data());
    keep_outside_bodies(system_, direction_);
    free_copy(state_, move, direction_);
}

// Moves bodies and pins on, with the cloth that they push; returns whether they still wait for it to make way.
bool Minimisation::advance_boundary()
{
    if (!system_.boundary_waits()) return false;
    const bool waits = system_.advance_boundary([this](std::vector<real>& move) { follow_pins(move); });
    base_ = state_.pos;
    return_to_base();  // the velocities of what was pushed
    return waits;
}

// Stiff directions leave forces that no longer move anything: what counts in a motion is the displacement, not the
// force. A displacement that contact has cut short says nothing, so it is that of the direction before it was limited.
// The promise is |d|^2 in the norm of the matrix, which is at least that of the mass over h^2; what the linear solve
// has not found of d comes on top. The longest way of a vertex alone says too little: linear solves that see the stiff
// directions first find short ways as well.
bool Minimisation::moves_little() const
{
    if (!is_solved()) return wanted_move_ <= options_.velocity_tolerance * objective_.span;
    return promised_ + energy_left_ <= energy_allowed_;
}

bool Minimisation::almost_converged() const
{
    return promised_ <= almost * energy_allowed_ + promise_noise * std::abs(value());
}

// An energy that is left as an acceleration, root mean square over the free mass.
double Minimisation::as_acceleration(double energy) const
{
    return std::sqrt(std::max(energy, 0.0) / free_mass_) / objective_.span;
}

// The acceleration that the net forces of the step would give every vertex on its own: more than what they give all
// together, since the matrix is at least that of the mass.
double Minimisation::acceleration_of_forces() const
{
    const int stride = state_.size.vertex_stride;
    const double sum = sum_items(state_.size.vertex_count, [&](int v) {
        double square = 0;
        for (int c = 0; c < 3; ++c) square += downhill_[c * stride + v] * downhill_[c * stride + v];
        return square * state_.inv_mass[v];
    });
    return std::sqrt(sum / free_mass_);
}

// @param settles  friction settles before each iteration
NewtonReport Minimisation::iterate(bool settles)
{
    for (;; ++report_.iterations) {
        report_.broken_off = options_.stop && *options_.stop && (*options_.stop)();
        if (report_.broken_off) return report_;
        const bool waits =
            report_.iterations % iterations_per_advance == 0 ? advance_boundary() : system_.boundary_waits();
        if (system_.bodies_exert_forces())
            system_.profile().timed("body_query", state_.size.vertex_count, 0, [&] { system_.refresh_planes(); });
        if (settles)
            system_.settle();
        else
            system_.refresh_air();
        evaluate_gradient();
        report_.residual = std::sqrt(dot(state_, downhill_, downhill_)) / system_.force_scale();
        report_.converged = !waits && report_.residual <= options_.tolerance;
        if (report_.converged && is_solved()) report_.acceleration_left = acceleration_of_forces();
        const int most = waits ? std::max(options_.max_iterations, most_waiting_iterations) : options_.max_iterations;
        if (report_.converged || report_.iterations >= most) return report_;
        const double slope = search_direction();
        report_.converged = !waits && moves_little();
        if (is_solved()) report_.acceleration_left = as_acceleration(promised_ + energy_left_);
        report_.stuck = !std::isfinite(slope) || !search_line(slope);
        report_.almost_converged = report_.stuck && almost_converged();
        if ((report_.stuck && !waits) || report_.converged) return report_;
    }
}

}  // namespace

NewtonReport Newton::minimise(double span, const std::vector<real>& origin, const std::vector<real>& target,
                              const NewtonOptions& options, const std::vector<real>* expected)
{
    State& state = system_.state();
    scale_difference(state.vel, 1 / span, state.pos, origin);
    Minimisation minimisation(system_, linear_, vectors_, {span, 1 / (span * span), origin, target}, options);
    minimisation.guess(expected);
    return minimisation.iterate(false);
}

NewtonReport Newton::relax(const NewtonOptions& options)
{
    State& state = system_.state();
    vectors_.start = state.pos;
    clear(state.vel);
    system_.refresh_pairs();
    return Minimisation(system_, linear_, vectors_, {0, 0, vectors_.start, vectors_.start}, options).iterate(true);
}

NewtonReport implicit_euler_step(Newton& newton, double dt, const NewtonOptions& options,
                                 std::vector<real>* free_flight, const std::vector<real>* expected)
{
    const State& state = newton.system().state();
    const std::vector<real> origin = state.pos;
    std::vector<real> own;
    std::vector<real>& target = free_flight ? *free_flight : own;
    target.resize(origin.size());
    add(target, origin, dt, state.vel);
    const NewtonReport report = newton.minimise(dt, origin, target, options, expected);
    newton.system().settle();
    return report;
}

}  // namespace selvage
