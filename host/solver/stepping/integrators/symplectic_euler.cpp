// v1 = v0 + dt a(x0, v0),   x1 = x0 + dt v1
// Source: Provot 1995, where the new velocity moves the vertex.
#include "host/solver/stepping/integrators/explicit_scheme.hpp"
#include "host/solver/stepping/integrators/list.hpp"

namespace selvage {
namespace {

class SymplecticEuler final : public ExplicitScheme {
public:
    SymplecticEuler(Phase& phase, const IntegratorInfo& info)
        : ExplicitScheme(phase, info), a_(phase.state().pos.size(), 0)
    {
    }

private:
    void move(double dt) override
    {
        accelerate(a_);
        State& s = state();
        add(s.vel, s.vel, dt, a_);
        add(s.pos, s.pos, dt, s.vel);
    }

    // Of a mode of frequency w and drag g the roots stay in the unit circle while dt^2 w^2 + 2 dt g <= 4.
    double limit(double w, double g) const override { return 4 / (g + std::sqrt(g * g + 4 * w * w)); }

    std::vector<real> a_;
};

}  // namespace

std::unique_ptr<Integrator> make_symplectic_euler_integrator(Phase& phase, const IntegratorInfo& info)
{
    return std::make_unique<SymplecticEuler>(phase, info);
}

}  // namespace selvage
