// The classical scheme of fourth order on y = (x, v), y' = (v, a):
//     k1 = y'(y), k2 = y'(y + dt/2 k1), k3 = y'(y + dt/2 k2), k4 = y'(y + dt k3),   y += dt/6 (k1 + 2 k2 + 2 k3 + k4)
// Moving the weight of k4 to the slope at the new state gives a companion of third order: the difference estimates
// its error, so the step is better than the estimate says.
// In contact with bodies it gains energy: its order holds for smooth forces, and the tangent planes are not.
// Source: Kutta 1901; the companion follows from the order conditions in Hairer, Norsett and Wanner 1993, ch. II.4.
#include "host/solver/stepping/integrators/explicit_scheme.hpp"
#include "host/solver/stepping/integrators/list.hpp"

namespace selvage {
namespace {

class Rk4 final : public ExplicitScheme {
public:
    Rk4(Phase& phase, const IntegratorInfo& info) : ExplicitScheme(phase, info)
    {
        for (std::vector<real>* v : {&x0_, &v0_, &way_, &gain_, &a_}) v->assign(phase.state().pos.size(), 0);
    }
    double error_estimate() const override { return error_; }

private:
    void move(double dt) override
    {
        State& s = state();
        x0_ = s.pos;
        v0_ = s.vel;
        for (std::vector<real>* v : {&way_, &gain_}) clear(*v);
        const double weight[4] = {dt / 6, dt / 3, dt / 3, dt / 6}, ahead[3] = {dt / 2, dt / 2, dt};
        for (int stage = 0; stage < 4; ++stage) {
            accelerate(a_);
            add(way_, way_, weight[stage], s.vel);
            add(gain_, gain_, weight[stage], a_);
            if (stage == 3) break;
            add(s.pos, x0_, ahead[stage], s.vel);
            add(s.vel, v0_, ahead[stage], a_);
        }
        a_ = s.vel;  // the velocity part of k4
        add(s.pos, x0_, 1, way_);
        add(s.vel, v0_, 1, gain_);
        error_ = dt / 6 * largest_distance(s, a_, s.vel);
    }

    // Elastic modes lie on the imaginary axis, which the stability region meets at sqrt(8); drag on the real one,
    // at 2.785.
    double limit(double w, double g) const override
    {
        return std::min(std::sqrt(8.0) / std::max(w, 1e-300), 2.785 / std::max(g, 1e-300));
    }

    std::vector<real> x0_, v0_, way_, gain_, a_;
    double error_ = 0;
};

}  // namespace

std::unique_ptr<Integrator> make_rk4_integrator(Phase& phase, const IntegratorInfo& info)
{
    return std::make_unique<Rk4>(phase, info);
}

}  // namespace selvage
