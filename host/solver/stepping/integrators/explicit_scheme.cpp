#include "host/solver/stepping/integrators/explicit_scheme.hpp"

#include <utility>

#include "host/solver/stepping/stability.hpp"

namespace selvage {
namespace {

constexpr int steps_between_estimates = 100;
constexpr int steps_in_contact = 10;  // the same where the barrier of a body may stiffen quickly

}  // namespace

NewtonReport ExplicitScheme::step(double dt, const NewtonOptions&)
{
    move(dt);
    phase_.system().settle();
    ++watch_[1];
    watch_[3] = contacts();
    NewtonReport report;
    report.converged = true;
    return report;
}

void ExplicitScheme::restart()
{
    watch_.assign(4, 0);
    displaced();
}

double ExplicitScheme::stable_step()
{
    const double change = std::abs(watch_[3] - watch_[2]);
    const int patience = watch_[3] > 0 ? steps_in_contact : steps_between_estimates;
    if (watch_[0] > 0 && watch_[1] < patience && change <= 8 + 0.2 * watch_[2]) return watch_[0];
    if (phase_.contact()) phase_.contact()->update(state());
    const double frequency = highest_frequency(phase_), drag = largest_drag_rate(phase_);
    watch_ = {limit(frequency, drag), 0, double(contacts()), double(contacts())};
    return watch_[0];
}

void ExplicitScheme::accelerate(std::vector<real>& a)
{
    State& s = state();
    // A state that has burst is no place to look for bodies; the caller finds out.
    if (phase_.contact() && is_finite(s)) phase_.contact()->update(s);
    if (is_finite(s)) phase_.system().refresh_pairs();
    phase_.system().refresh_air();
    phase_.system().evaluate_forces(true);
    weigh(vertex_planes(s.size, a), s.inv_mass, vertex_planes(s.size, std::as_const(s.force)));
}

}  // namespace selvage
