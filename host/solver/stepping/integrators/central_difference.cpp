// Central differences in position, with the drag c between them:
//     (m/dt^2 + c/(2 dt)) d1 = f(x0) + (m/dt^2 - c/(2 dt)) d0,   d1 = x1 - x0,  d0 = x0 - x(-1)
// which is A7 in the ways d of two steps. c is d2R/dv2 at the present velocity v, and f holds what the drag force
// there is beside -c v, so that drag which is not linear is treated in the second order as well.
// The first step, and one of another length, starts from d0 = dt v - dt^2/2 a; at rest this is the source's x(-1) = x0
// but for the order. After a step of length k, v = d0/k + k/2 a with the acceleration at its end: the one at its start,
// which the velocity that the step leaves is made of, would feed energy to fast modes at every change of length.
// Source: Fan, Zhou, Wang and Yuen 1998 (A7).
#include <Eigen/Dense>

#include "host/parallel/launch.hpp"
#include "host/solver/stepping/integrators/explicit_scheme.hpp"
#include "host/solver/stepping/integrators/list.hpp"

namespace selvage {
namespace {

class CentralDifference final : public ExplicitScheme {
public:
    CentralDifference(Phase& phase, const IntegratorInfo& info) : ExplicitScheme(phase, info)
    {
        for (std::vector<real>* v : {&way_, &a_}) v->assign(phase.state().pos.size(), 0);
    }
    void displaced() override { last_dt_[0] = 0; }
    std::vector<std::vector<real>*> history() override
    {
        auto all = ExplicitScheme::history();
        all.insert(all.end(), {&way_, &last_dt_});
        return all;
    }

private:
    void move(double dt) override
    {
        State& s = state();
        accelerate(a_);
        // Lengths that differ by rounding only are the same.
        const double last = last_dt_[0];
        if (std::abs(dt - last) > 1e-9 * dt)
            for_each_item(size(), [&, dt, last](int i) {
                const double velocity = last > 0 ? way_[i] / last + 0.5 * last * a_[i] : s.vel[i];
                way_[i] = dt * (velocity - 0.5 * dt * a_[i]);
            });
        if (phase_.newton().terms().dissipates())
            swing_with_drag(dt);
        else
            for_each_item(size(), [&, dt](int i) { way_[i] += dt * dt * a_[i]; });
        for_each_item(size(), [&, dt](int i) {
            s.pos[i] += way_[i];
            s.vel[i] = way_[i] / dt + 0.5 * dt * a_[i];
        });
        last_dt_[0] = dt;
    }

    // From d0 to d1 where there is drag.
    void swing_with_drag(double dt)
    {
        State& s = state();
        phase_.newton().terms().evaluate_drag();
        const int vs = s.size.vertex_stride;
        for_each_item(s.size.vertex_count, [&, vs, dt](int v) {
            const auto three = [vs, v](const std::vector<real>& f) { return Vec3(f[v], f[vs + v], f[2 * vs + v]); };
            using Block = Eigen::Matrix<block_real, 3, 3, Eigen::RowMajor>;
            const Eigen::Matrix3d drag =
                s.inv_mass[v] * Eigen::Map<const Block>(s.vertex_stiffness.data() + 9 * v).cast<double>();
            const Vec3 last = three(way_);
            const Eigen::Matrix3d left = Eigen::Matrix3d::Identity() + 0.5 * dt * drag;
            const Vec3 right = dt * dt * (three(a_) + drag * three(s.vel)) + last - 0.5 * dt * (drag * last);
            const Vec3 way = left.inverse() * right;
            for (int c = 0; c < 3; ++c) way_[c * vs + v] = way[c];
        });
    }

    double limit(double w, double) const override { return 2 / std::max(w, 1e-300); }  // with drag or without

    std::vector<real> way_, a_, last_dt_{0};
};

}  // namespace

std::unique_ptr<Integrator> make_central_difference_integrator(Phase& phase, const IntegratorInfo& info)
{
    return std::make_unique<CentralDifference>(phase, info);
}

}  // namespace selvage
