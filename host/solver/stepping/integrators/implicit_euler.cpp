// m (v1 - v0) / dt = f(x1, v1),   x1 = x0 + dt v1
// Source: Baraff and Witkin 1998.
#include "host/solver/state/vectors.hpp"
#include "host/solver/stepping/integrators/list.hpp"
#include "host/solver/stepping/integrators/rigid_flight.hpp"
#include "host/solver/stepping/phase.hpp"

namespace selvage {
namespace {

class ImplicitEuler final : public Integrator {
public:
    ImplicitEuler(Phase& phase, const IntegratorInfo& info)
        : phase_(phase), info_(info), flight_(phase.state()), last_gain_(phase.state().pos.size(), 0)
    {
    }
    const IntegratorInfo& info() const override { return info_; }
    void restart() override { last_dt_[0] = 0; }
    std::vector<HistoryArray> history() override { return {{"last_gain", &last_gain_}, {"last_dt", &last_dt_}}; }

    NewtonReport step(double dt, const NewtonOptions& options) override
    {
        const State& s = phase_.state();
        const bool solves = options.acceleration_left > 0;
        if (solves) predict(dt);
        start_vel_ = s.vel;
        const NewtonReport report =
            implicit_euler_step(phase_.newton(), dt, options, &free_flight_, solves ? &flown_ : nullptr);
        scale_difference(last_gain_, 1, s.vel, start_vel_);
        last_dt_[0] = dt;
        return report;
    }

    // The step errs by +dt^2/2 a and free flight by -dt^2/2 a: half their difference (Milne's device).
    double error_estimate() const override
    {
        return 0.5 * largest_distance(phase_.state(), phase_.state().pos, free_flight_);
    }

private:
    // Where the cloth flies on rigidly, with the acceleration of the last step or, at first, that of gravity.
    void predict(double dt)
    {
        fill_acceleration(phase_.state(), phase_.params(), last_gain_, last_dt_[0], acceleration_);
        flight_.predict(phase_.state(), dt, dt * dt, acceleration_, flown_);
    }

    Phase& phase_;
    const IntegratorInfo& info_;
    RigidFlight flight_;
    std::vector<real> free_flight_, last_gain_, last_dt_{0}, start_vel_, acceleration_, flown_;
};

}  // namespace

std::unique_ptr<Integrator> make_implicit_euler_integrator(Phase& phase, const IntegratorInfo& info)
{
    return std::make_unique<ImplicitEuler>(phase, info);
}

}  // namespace selvage
