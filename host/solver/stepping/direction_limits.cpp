#include "host/solver/stepping/direction_limits.hpp"

#include <algorithm>
#include <cmath>

#include "host/parallel/launch.hpp"
#include "host/solver/state/vectors.hpp"
#include "kernels/stages/limit_step.h"

namespace selvage {
namespace {

limit_step_args limit_step(const System& system, std::vector<real>& direction)
{
    const State& state = system.state();
    return {state.pos.data(), state.contact_normal.data(), state.contact_offset.data(), direction.data(),
            state.size.vertex_stride};
}

void scale_to_longest(const System& system, const MoveLimits& limits, std::vector<real>& direction)
{
    const double fraction = longest_fraction(system, limits, direction);
    if (fraction < 1) scale(direction, fraction);
}

// Shortens the direction as a whole until no vertex passes its contact plane.
void scale_to_planes(const System& system, std::vector<real>& direction)
{
    if (!system.bodies_exert_forces()) return;
    const double excess =
        launch_max<limit_step_excess>(system.state().size.vertex_count, limit_step(system, direction));
    if (excess > 1) scale(direction, 1 / excess);
}

}  // namespace

double largest_move(const State& state, const std::vector<real>& direction)
{
    return std::sqrt(largest_square(state, direction));
}

double longest_fraction(const System& system, const MoveLimits& limits, const std::vector<real>& direction)
{
    if (!system.bodies_exert_forces()) return 1;
    const State& state = system.state();
    const limit_move_args args{state.contact_normal.data(), direction.data(), limits.near_bodies, limits.elsewhere,
                               state.size.vertex_stride};
    const double excess = launch_max<limit_move_excess>(state.size.vertex_count, args);
    return excess > 1 ? 1 / excess : 1;
}

void keep_outside_bodies(const System& system, std::vector<real>& direction)
{
    if (!system.bodies_exert_forces()) return;
    launch<limit_step_vertex>(system.state().size.vertex_count, limit_step(system, direction));
}

void limit_guess(System& system, const MoveLimits& limits, std::vector<real>& direction)
{
    keep_outside_bodies(system, direction);
    if (!system.cloth_contact()) return;
    scale_to_longest(system, limits, direction);
    system.limit_by_pairs(direction, false);
}

void limit_descent(System& system, const MoveLimits& limits, const std::vector<real>& downhill,
                   std::vector<real>& direction, std::vector<real>& unlimited)
{
    const auto leads_up = [&] { return dot(system.state(), downhill, direction) <= 0; };
    const auto start_over = [&] {
        direction = unlimited;
        scale_to_planes(system, direction);
    };
    unlimited = direction;
    keep_outside_bodies(system, direction);
    if (leads_up()) start_over();
    if (!system.cloth_contact()) return;
    scale_to_longest(system, limits, direction);
    system.limit_by_pairs(direction, false);
    if (!leads_up()) return;
    start_over();
    scale_to_longest(system, limits, direction);
    system.limit_by_pairs(direction, true);
}

}  // namespace selvage
