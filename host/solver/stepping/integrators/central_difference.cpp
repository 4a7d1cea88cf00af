// Central differences in position, with the drag c between them:
//     (m/dt^2 + c/(2 dt)) d1 = f(x0) + (m/dt^2 - c/(2 dt)) d0,   d1 = x1 - x0,  d0 = x0 - x(-1)
// which is the scheme of the source below in the displacements d of two steps. c is d2R/dv2 at the present velocity v,
// and f holds what the drag force there is beside -c v, so that drag which is not linear is treated in the second order
// as well. The first step, and one of another length, starts from d0 = dt v - dt^2/2 a; at rest this is the source's
// x(-1) = x0 but for the order. After a step of length k, v = d0/k + k/2 a with the acceleration at its end: the one at
// its start, which the velocity that the step leaves is made of, would feed energy to fast modes at every change of
// length. Source: Fan, Zhou, Wang and Yuen 1998.
#include <Eigen/Dense>

#include "host/parallel/launch.hpp"
#include "host/solver/stepping/integrators/explicit_scheme.hpp"
#include "host/solver/stepping/integrators/list.hpp"
#include "kernels/stages/integrator_steps.h"

namespace selvage {
namespace {

class CentralDifference final : public ExplicitScheme {
public:
    CentralDifference(Phase& phase, const IntegratorInfo& info) : ExplicitScheme(phase, info)
    {
        for (std::vector<real>* v : {&way_, &a_}) v->assign(phase.state().pos.size(), 0);
    }
    void displaced() override { last_dt_[0] = 0; }
    std::vector<HistoryArray> history() override
    {
        auto all = ExplicitScheme::history();
        all.insert(all.end(), {{"way", &way_}, {"last_dt", &last_dt_}});
        return all;
    }

private:
    void move(double dt) override
    {
        State& s = state();
        accelerate(a_);
        const double last = last_dt_[0];
        const central_args args{s.pos.data(), s.vel.data(), way_.data(), a_.data(), dt, last};
        // Lengths that differ by rounding only are the same.
        if (std::abs(dt - last) > 1e-9 * dt) launch<central_restart>(size(), args);
        if (phase_.system().dissipates())
            swing_with_drag(dt);
        else
            add(way_, way_, dt * dt, a_);
        launch<central_finish>(size(), args);
        last_dt_[0] = dt;
    }

    // From d0 to d1 where there is drag.
    void swing_with_drag(double dt)
    {
        State& s = state();
        phase_.system().evaluate_drag();
        const Planes ways = vertex_planes(s.size, way_), velocities = vertex_planes(s.size, s.vel),
                     accelerations = vertex_planes(s.size, a_);
        for_each_item(ways.count, [=, &s](int v) {
            using Block = Eigen::Matrix<block_real, 3, 3, Eigen::RowMajor>;
            const Eigen::Matrix3d drag =
                s.inv_mass[v] * Eigen::Map<const Block>(s.vertex_stiffness.data() + 9 * v).cast<double>();
            const Vec3 last = ways(v);
            const Eigen::Matrix3d left = Eigen::Matrix3d::Identity() + 0.5 * dt * drag;
            const Vec3 right = dt * dt * (accelerations(v) + drag * velocities(v)) + last - 0.5 * dt * (drag * last);
            ways.set(v, left.inverse() * right);
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
