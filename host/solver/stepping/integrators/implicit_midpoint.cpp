// Half a step of implicit Euler, then as far again:
//     m (vm - v0) / (dt/2) = f(xm, vm),   xm = x0 + dt/2 vm,   x1 = 2 xm - x0,   v1 = 2 vm - v0
// Source: Hairer, Lubich and Wanner 2006, ch. II.1.
#include "host/parallel/launch.hpp"
#include "host/solver/state/vector_tools.hpp"
#include "host/solver/stepping/integrators/list.hpp"
#include "host/solver/stepping/phase.hpp"

namespace selvage {
namespace {

class ImplicitMidpoint final : public Integrator {
public:
    ImplicitMidpoint(Phase& phase, const IntegratorInfo& info) : phase_(phase), info_(info)
    {
        for (std::vector<real>* v : {&acceleration_, &before_, &start_, &start_vel_, &target_, &expected_})
            v->assign(phase.state().pos.size(), 0);
    }
    const IntegratorInfo& info() const override { return info_; }
    // It keeps the energy of linear motion only.
    bool may_gain_energy() const override { return true; }
    void restart() override { last_dt_[0] = 0; }
    std::vector<std::vector<real>*> history() override { return {&acceleration_, &last_dt_}; }
    double error_estimate() const override { return error_; }

    NewtonReport step(double dt, const NewtonOptions& options) override
    {
        State& s = phase_.state();
        const int n = int(s.pos.size());
        start_ = s.pos;
        start_vel_ = s.vel;
        before_ = acceleration_;
        for_each_item(n, [&, dt](int i) {
            target_[i] = s.pos[i] + 0.5 * dt * s.vel[i];
            expected_[i] = target_[i] + 0.25 * dt * dt * acceleration_[i];
        });
        const bool first = last_dt_[0] == 0;
        const NewtonReport report =
            phase_.newton().minimise(0.5 * dt, start_, target_, options, first ? nullptr : &expected_);
        for_each_item(n, [&, dt](int i) {
            s.pos[i] += s.pos[i] - start_[i];
            s.vel[i] += s.vel[i] - start_vel_[i];
            acceleration_[i] = (s.vel[i] - start_vel_[i]) / dt;
        });
        phase_.newton().settle();
        // dt^3/12 x''', the third derivative from the middles of two steps; at first from an acceleration that set in.
        if (last_dt_[0] == 0) before_.assign(before_.size(), 0);
        error_ = dt * dt * dt / 6 / (dt + last_dt_[0]) * largest_distance(s, acceleration_, before_);
        last_dt_[0] = dt;
        return report;
    }

private:
    Phase& phase_;
    const IntegratorInfo& info_;
    std::vector<real> acceleration_, before_, last_dt_{0}, start_, start_vel_, target_, expected_;
    double error_ = 0;
};

}  // namespace

std::unique_ptr<Integrator> make_implicit_midpoint_integrator(Phase& phase, const IntegratorInfo& info)
{
    return std::make_unique<ImplicitMidpoint>(phase, info);
}

}  // namespace selvage
