// x1 = x0 + dt v0 + dt^2/2 a0,   v1 = v0 + dt/2 (a0 + a1)
// a1 = a(x1, v0 + dt a0): where forces depend on velocity the predicted one keeps the second order. a1 serves the next
// step, which errs by dt^2 times its change and so not in the order either.
// Source: Swope and others 1982.
#include "host/parallel/launch.hpp"
#include "host/solver/stepping/integrators/explicit_scheme.hpp"
#include "host/solver/stepping/integrators/list.hpp"
#include "kernels/stages/integrator_steps.h"

namespace selvage {
namespace {

class VelocityVerlet final : public ExplicitScheme {
public:
    VelocityVerlet(Phase& phase, const IntegratorInfo& info)
        : ExplicitScheme(phase, info), a_(phase.state().pos.size(), 0), next_(a_)
    {
    }
    void displaced() override { known_[0] = 0; }
    std::vector<HistoryArray> history() override
    {
        auto all = ExplicitScheme::history();
        all.insert(all.end(), {{"acceleration", &a_}, {"acceleration_known", &known_}});
        return all;
    }
    double error_estimate() const override { return error_; }

private:
    void move(double dt) override
    {
        if (known_[0] == 0) accelerate(a_);
        const verlet_args args{state().pos.data(), state().vel.data(), a_.data(), next_.data(), dt};
        launch<verlet_start>(size(), args);
        accelerate(next_);
        launch<verlet_finish>(size(), args);
        error_ = dt * dt / 6 * largest_distance(state(), next_, a_);  // dt^3 x'''/6
        a_.swap(next_);
        known_[0] = 1;
    }

    // A root passes -1 where dt^2 w^2 + 4 dt g = 4: the price of predicting the velocity.
    double limit(double w, double g) const override { return 2 / (g + std::sqrt(g * g + w * w)); }

    std::vector<real> a_, next_, known_{0};
    double error_ = 0;
};

}  // namespace

std::unique_ptr<Integrator> make_velocity_verlet_integrator(Phase& phase, const IntegratorInfo& info)
{
    return std::make_unique<VelocityVerlet>(phase, info);
}

}  // namespace selvage
