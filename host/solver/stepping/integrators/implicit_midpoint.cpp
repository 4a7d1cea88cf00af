// Half a step of implicit Euler, then as far again:
//     m (vm - v0) / (dt/2) = f(xm, vm),   xm = x0 + dt/2 vm,   x1 = 2 xm - x0,   v1 = 2 vm - v0
// Source: Hairer, Lubich and Wanner 2006, ch. II.1.
#include "host/parallel/launch.hpp"
#include "host/solver/state/vectors.hpp"
#include "host/solver/stepping/integrators/list.hpp"
#include "host/solver/stepping/integrators/rigid_flight.hpp"
#include "host/solver/stepping/phase.hpp"
#include "kernels/stages/integrator_steps.h"

namespace selvage {
namespace {

class ImplicitMidpoint final : public Integrator {
public:
    ImplicitMidpoint(Phase& phase, const IntegratorInfo& info) : phase_(phase), info_(info), flight_(phase.state())
    {
        for (std::vector<real>* v : {&acceleration_, &before_, &start_, &start_vel_, &target_, &expected_})
            v->assign(phase.state().pos.size(), 0);
    }
    const IntegratorInfo& info() const override { return info_; }
    // It keeps the energy of linear motion only.
    bool may_gain_energy() const override { return true; }
    void restart() override { last_dt_[0] = 0; }
    std::vector<HistoryArray> history() override { return {{"acceleration", &acceleration_}, {"last_dt", &last_dt_}}; }
    double error_estimate() const override { return error_; }

    NewtonReport step(double dt, const NewtonOptions& options) override
    {
        State& s = phase_.state();
        start_ = s.pos;
        start_vel_ = s.vel;
        before_ = acceleration_;
        add(target_, s.pos, 0.5 * dt, s.vel);
        add(expected_, target_, 0.25 * dt * dt, acceleration_);
        const bool solves = options.acceleration_left > 0, first = last_dt_[0] == 0;
        if (solves) {
            if (first) fill_gravity(s, phase_.params(), before_);
            flight_.predict(s, 0.5 * dt, 0.25 * dt * dt, before_, expected_);
        }
        const NewtonReport report =
            phase_.newton().minimise(0.5 * dt, start_, target_, options, first && !solves ? nullptr : &expected_);
        launch<midpoint_finish>(int(s.pos.size()), midpoint_args{s.pos.data(), s.vel.data(), acceleration_.data(),
                                                                 start_.data(), start_vel_.data(), dt});
        phase_.system().settle();
        // dt^3/12 x''', the third derivative from the middles of two steps; at first from an acceleration that set in.
        if (last_dt_[0] == 0) before_.assign(before_.size(), 0);
        error_ = dt * dt * dt / 6 / (dt + last_dt_[0]) * largest_distance(s, acceleration_, before_);
        last_dt_[0] = dt;
        return report;
    }

private:
    Phase& phase_;
    const IntegratorInfo& info_;
    RigidFlight flight_;
    std::vector<real> acceleration_, before_, last_dt_{0}, start_, start_vel_, target_, expected_;
    double error_ = 0;
};

}  // namespace

std::unique_ptr<Integrator> make_implicit_midpoint_integrator(Phase& phase, const IntegratorInfo& info)
{
    return std::make_unique<ImplicitMidpoint>(phase, info);
}

}  // namespace selvage
