// m (v1 - v0) / dt = f(x1, v1),   x1 = x0 + dt v1
// Source: Baraff and Witkin 1998.
#include "host/solver/state/vectors.hpp"
#include "host/solver/stepping/integrators/list.hpp"
#include "host/solver/stepping/phase.hpp"

namespace selvage {
namespace {

class ImplicitEuler final : public Integrator {
public:
    ImplicitEuler(Phase& phase, const IntegratorInfo& info) : phase_(phase), info_(info) {}
    const IntegratorInfo& info() const override { return info_; }

    NewtonReport step(double dt, const NewtonOptions& options) override
    {
        return implicit_euler_step(phase_.newton(), dt, options, &free_flight_);
    }

    // The step errs by +dt^2/2 a and free flight by -dt^2/2 a: half their difference (Milne's device).
    double error_estimate() const override
    {
        return 0.5 * largest_distance(phase_.state(), phase_.state().pos, free_flight_);
    }

private:
    Phase& phase_;
    const IntegratorInfo& info_;
    std::vector<real> free_flight_;
};

}  // namespace

std::unique_ptr<Integrator> make_implicit_euler_integrator(Phase& phase, const IntegratorInfo& info)
{
    return std::make_unique<ImplicitEuler>(phase, info);
}

}  // namespace selvage
