// Pseudo-transient continuation to rest: x1 minimises m |x - x0|^2 / (2 h^2) + E(x), with h growing as that succeeds.
// Far from rest this follows the slope of the energy in small steps, near it it is Newton's method.
// Source: Kelley and Keyes 1998; the same regularisation is that of Levenberg 1944 with the mass as weight.
#include <algorithm>
#include <cmath>

#include "host/solver/stepping/integrators/list.hpp"
#include "host/solver/stepping/phase.hpp"

namespace selvage {
namespace {

constexpr double most_boost = 1e6, growth = 2;

class StaticDescent final : public Integrator {
public:
    StaticDescent(Phase& phase, const IntegratorInfo& info) : phase_(phase), info_(info) {}
    const IntegratorInfo& info() const override { return info_; }
    void restart() override { memory_.assign(2, 0); }
    std::vector<HistoryArray> history() override { return {{"boost_and_residual", &memory_}}; }

    NewtonReport step(double dt, const NewtonOptions& options) override
    {
        State& s = phase_.state();
        double &boost = memory_[0], &last_residual = memory_[1];
        if (boost == 0) boost = 1;
        const std::vector<real> start = s.pos;
        const NewtonReport report = phase_.newton().minimise(boost * dt, start, start, options);
        std::fill(s.vel.begin(), s.vel.end(), 0);
        phase_.system().settle();
        phase_.system().refresh_pairs();
        const double residual = phase_.system().residual();
        // A residual that stays, as in free flight, asks for longer steps as much as one that falls.
        const double ratio = last_residual > 0 ? last_residual / std::max(residual, 1e-300) : 1;
        boost = std::clamp(boost * (report.stuck ? 0.25 : std::clamp(growth * ratio, 0.5, growth)), 1e-3, most_boost);
        last_residual = residual;
        return report;
    }

private:
    Phase& phase_;
    const IntegratorInfo& info_;
    std::vector<real> memory_{0, 0};  // factor of the step; residual after the last one
};

}  // namespace

std::unique_ptr<Integrator> make_quasistatic_integrator(Phase& phase, const IntegratorInfo& info)
{
    return std::make_unique<StaticDescent>(phase, info);
}

}  // namespace selvage
