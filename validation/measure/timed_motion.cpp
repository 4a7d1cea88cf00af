#include "validation/measure/timed_motion.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

#include "host/solver/state/planes.hpp"
#include "host/solver/state/vectors.hpp"
#include "host/solver/terms/params.hpp"
#include "io/scene/read_scene.hpp"

namespace selvage {
namespace {

// How steps are solved again. Places are known to 16 digits, which leaves forces of some 1e-5 weights in the stiffest
// sheets, and 1e-7 in the others.
constexpr double again_residual = 1e-7, again_left = 1e-6;  // over the weight, over gravity
constexpr double again_known = 1e-3;                        // must be reached, over gravity
constexpr int again_iterations = 400;

SceneModel model_of(const std::string& scene) { return build_scene_model(read_scene_text(scene, "motion.toml")); }

}  // namespace

TimedMotion::TimedMotion(const std::string& scene)
    : model_(model_of(scene)), settings_(make_run_settings(read_scene_text(scene, "motion.toml"), model_))
{
    if (meets_bodies(settings_.cloth.draping.params))
        query_.emplace(model_.cloth_model.bodies, cloth_reach(model_.cloth_model.cloth));
    start_with([](const Vec3&) { return Vec3(Vec3::Zero()); });
}

void TimedMotion::start_at(const std::function<Vec3(const Vec2&)>& place)
{
    Cloth& cloth = model_.cloth_model.cloth;
    for (std::size_t v = 0; v < cloth.positions.size(); ++v) cloth.positions[v] = place(cloth.panel_coordinates[v]);
    start_with([](const Vec3&) { return Vec3(Vec3::Zero()); });
}

void TimedMotion::start_with(const std::function<Vec3(const Vec3&)>& velocity)
{
    const std::vector<Vec3>& places = model_.cloth_model.cloth.positions;
    std::vector<Vec3> velocities;
    for (const Vec3& place : places) velocities.push_back(velocity(place));
    integrator_.reset();
    phase_ = std::make_unique<Phase>(model_.cloth_model, settings_.cloth.draping, query_ ? &*query_ : nullptr, profile_,
                                     places, velocities);
    integrator_ = make_integrator(word_of(settings_.integrator), *phase_);
}

Vec3 TimedMotion::center() const
{
    const State& s = phase_->state();
    const ConstPlanes x = vertex_planes(s.size, s.pos);
    Vec3 sum = Vec3::Zero();
    double mass = 0;
    for (int v = 0; v < x.count; ++v) {
        sum += s.mass[v] * x(v);
        mass += s.mass[v];
    }
    return sum / mass;
}

Vec3 TimedMotion::angular_momentum() const
{
    const State& s = phase_->state();
    const ConstPlanes x = vertex_planes(s.size, s.pos), u = vertex_planes(s.size, s.vel);
    const Vec3 middle = center();
    Vec3 sum = Vec3::Zero();
    for (int v = 0; v < x.count; ++v) sum += s.mass[v] * (x(v) - middle).cross(u(v));
    return sum;
}

double TimedMotion::pendulum_length(const Vec3& axis) const
{
    const State& s = phase_->state();
    const ConstPlanes x = vertex_planes(s.size, s.pos);
    double first = 0, second = 0;
    for (int v = 0; v < x.count; ++v) {
        const Vec3 arm = x(v) - axis;
        const double square = arm.x() * arm.x() + arm.z() * arm.z();
        first += s.mass[v] * std::sqrt(square);
        second += s.mass[v] * square;
    }
    return second / first;
}

void TimedMotion::return_to(const SolverSnapshot& place, double time)
{
    System& system = phase_->system();
    system.clock() = {time, 0};
    restore(system, integrator_.get(), place);
    system.refresh_air();
    system.refresh_planes();
    system.refresh_pairs();
}

double TimedMotion::missed(const StepEvent& event)
{
    System& system = phase_->system();
    const State& s = system.state();
    const double begin = event.time - event.dt, gravity = system.gravity_scale();
    keep(system, integrator_.get(), after_);
    return_to(before_, begin);
    system.clock() = {begin, event.dt};
    NewtonOptions newton;
    newton.max_iterations = again_iterations;
    newton.tolerance = again_residual;
    newton.acceleration_left = again_left * gravity;
    const NewtonReport report = integrator_->step(event.dt, newton);
    if (!report.converged && report.acceleration_left > again_known * gravity)
        throw std::runtime_error(
            fmt::format("the step that ends at {:.4g} s cannot be solved to the end: {:.1e} of "
                        "gravity is left",
                        event.time, report.acceleration_left / gravity));
    std::vector<real> error(s.pos.size());
    scale_difference(error, 1, s.pos, after_.fields.pos);
    return_to(after_, event.time);
    before_ = after_;
    return std::sqrt(mass_square(s, error) / free_mass(s)) / (gravity * event.dt * event.dt);
}

MotionStep TimedMotion::step_of(const StepEvent& event)
{
    const double frame = 1 / settings_.frame_rate, begin = event.time - event.dt;
    const double room = std::min(frame * (std::floor(begin / frame + 1e-6) + 1), settings_.until.time) - begin;
    const bool divided = event.dt < 0.999 * room / std::ceil(room / settings_.drape.step.longest - 1e-6);
    MotionStep step{event.time, event.dt, event.newton_iterations, event.left, event.solved, divided, center()};
    if (solves_again_) step.missed = missed(event);
    return step;
}

std::vector<MotionStep> TimedMotion::run(const std::function<bool(const MotionStep&)>& go_on)
{
    std::vector<MotionStep> steps;
    EquilibriumOptions options = settings_.drape;
    options.integrator = integrator_.get();
    DrapeProgress progress;
    if (solves_again_) keep(phase_->system(), integrator_.get(), before_);
    drape_until(*phase_, options, settings_.until.time, 1 / settings_.frame_rate, progress,
                [&](const StepEvent& event) {
                    steps.push_back(step_of(event));
                    return !go_on || go_on(steps.back());
                });
    return steps;
}

MissedSteps missed_steps(const std::vector<MotionStep>& steps)
{
    MissedSteps result;
    for (const MotionStep& step : steps) {
        result.worst = std::max(result.worst, step.missed);
        result.over_bound = std::max(result.over_bound, step.missed - step.left);
    }
    return result;
}

}  // namespace selvage
