#include "host/solver/step_control.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "io/errors.hpp"

namespace selvage {

bool StepControl::attempt(double dt, const NewtonOptions& options, bool accurate)
{
    report_ = phase_.newton().step(dt, options);
    if (!std::isfinite(report_.residual)) return false;
    if (report_.stuck && report_.iterations == 0 && report_.residual > 10 * options.tolerance) return false;
    if (accurate && !report_.converged && !report_.stuck) return false;
    return !phase_.contact() || !phase_.contact()->crossed(phase_.state(), pos_);
}

double StepControl::advance(double room, const NewtonOptions& options, bool accurate)
{
    State& state = phase_.state();
    pos_ = state.pos;
    vel_ = state.vel;
    anchor_ = state.friction_anchor;
    limit_ = state.friction_limit;
    for (;;) {
        const double dt = std::min(dt_, room);
        if (attempt(dt, options, accurate)) {
            dt_ = std::min(longest_, 1.5 * dt_);
            taken_ = dt;
            return dt;
        }
        ++retries_;
        state.pos = pos_;
        state.vel = vel_;
        state.friction_anchor = anchor_;
        state.friction_limit = limit_;
        dt_ = 0.5 * dt;
        if (dt_ < longest_ / 1024)
            throw DivergenceError(fmt::format("no step down to {:.3g} s succeeds (solver.step is {:.3g} s); residual {:.3g}",
                                              dt_, longest_, report_.residual));
    }
}

}  // namespace selvage
