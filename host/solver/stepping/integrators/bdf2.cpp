// Second-order backward differences with steps of any lengths, w = dt / (length of the step before):
//     (1 + 2w)/(1 + w) x1 - (1 + w) x0 + w^2/(1 + w) x(-1) = dt v1,   the same for v1 and a1
// The first step is one of the implicit midpoint rule: with implicit Euler's, fast modes show its first order for long.
// It ends beyond what was solved for, where cloth could have met itself: with such contact it is one of implicit Euler.
// So it is after a velocity filter has moved the state, since that happens step after step and the midpoint rule damps
// nothing. Source: Gear 1971; Hairer, Norsett and Wanner 1993, ch. III.5 for variable steps.
#include "host/parallel/launch.hpp"
#include "host/solver/state/vectors.hpp"
#include "host/solver/stepping/integrators/list.hpp"
#include "host/solver/stepping/phase.hpp"
#include "kernels/stages/integrator_steps.h"

namespace selvage {
namespace {

constexpr double after_rule = -1;  // in place of the length of the step before

class Bdf2 final : public Integrator {
public:
    Bdf2(Phase& phase, const IntegratorInfo& info) : phase_(phase), info_(info)
    {
        for (std::vector<real>* v : {&last_way_, &last_gain_, &origin_, &target_, &guess_})
            v->assign(phase.state().pos.size(), 0);
    }
    const IntegratorInfo& info() const override { return info_; }
    void restart() override { last_dt_[0] = 0; }
    void displaced() override { last_dt_[0] = after_rule; }
    std::vector<HistoryArray> history() override
    {
        return {{"last_way", &last_way_}, {"last_gain", &last_gain_}, {"last_dt", &last_dt_}};
    }
    double error_estimate() const override { return error_; }

    NewtonReport step(double dt, const NewtonOptions& options) override
    {
        State& s = phase_.state();
        const bool first = last_dt_[0] <= 0;
        // Ways and gains instead of old positions and velocities: pinned vertices then stay to the last bit.
        const bool midpoint = last_dt_[0] == 0 && !phase_.cloth_contact();
        const double w = first ? 0 : dt / last_dt_[0], c = w * w / (1 + 2 * w);
        const double h = midpoint ? 0.5 * dt : (1 + w) / (1 + 2 * w) * dt;
        const double parabola = first ? 0 : w * w;
        const bdf2_args args{s.pos.data(),
                             s.vel.data(),
                             last_way_.data(),
                             last_gain_.data(),
                             origin_.data(),
                             target_.data(),
                             guess_.data(),
                             dt,
                             w,
                             c,
                             h,
                             parabola,
                             midpoint};
        const int n = int(s.pos.size());
        launch<bdf2_start>(n, args);
        const NewtonReport report = phase_.newton().minimise(h, origin_, target_, options, first ? nullptr : &guess_);
        launch<bdf2_finish>(n, args);
        last_dt_[0] = dt;
        phase_.system().settle();
        // At first free flight is the guess, and its error a bound.
        // Later the guess errs by -(1 + w)/w dt^3 x'''/6, the step by (1 + w)^2/(w (1 + 2w)) of it (Milne's device).
        error_ = (first ? 1 : (1 + w) / (2 + 3 * w)) * largest_distance(s, s.pos, guess_);
        return report;
    }

private:
    Phase& phase_;
    const IntegratorInfo& info_;
    std::vector<real> last_way_, last_gain_, last_dt_{0}, origin_, target_, guess_;
    double error_ = 0;
};

}  // namespace

std::unique_ptr<Integrator> make_bdf2_integrator(Phase& phase, const IntegratorInfo& info)
{
    return std::make_unique<Bdf2>(phase, info);
}

}  // namespace selvage
