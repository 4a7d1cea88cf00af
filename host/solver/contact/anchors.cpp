#include "host/solver/contact/anchors.hpp"

#include "host/parallel/launch.hpp"
#include "host/solver/terms/bound_args.hpp"
#include "kernels/stages/hold_friction.h"
#include "kernels/stages/settle_friction.h"
#include "kernels/stages/settle_hysteresis.h"

namespace selvage {
namespace {

settle_friction_args settle_args(State& state, const Params& params)
{
    settle_friction_args a;
    a.contact = bound<body_contact_args>(state, params);
    a.repulsion = bound<body_repulsion_args>(state, params);
    a.stick_distance = params.friction.stick_distance;
    settle_friction_FIELDS(BIND_FIELD, BIND_FIELD);
    return a;
}

hold_friction_args hold_args(State& state, const Params& params)
{
    hold_friction_args a;
    a.stick_distance = params.friction.stick_distance;
    a.stride = state.size.vertex_stride;
    hold_friction_FIELDS(BIND_FIELD, BIND_FIELD);
    return a;
}

settle_hysteresis_args hysteresis_args(State& state, const Params& params)
{
    settle_hysteresis_args a;
    a.hysteresis = bound<bending_hysteresis_args>(state, params);
    settle_hysteresis_FIELDS(BIND_FIELD, BIND_FIELD);
    return a;
}

}  // namespace

void settle_friction(State& state, const Params& params)
{
    if (state.friction_anchor.empty()) return;
    launch<settle_friction_vertex>(state.size.vertex_count, settle_args(state, params));
}

void hold_by_friction(State& state, const Params& params)
{
    if (state.friction_anchor.empty()) return;
    launch<hold_friction_vertex>(state.size.vertex_count, hold_args(state, params));
}

void settle_hysteresis(State& state, const Params& params)
{
    if (state.hinge_anchor.empty()) return;
    launch<settle_hysteresis_hinge>(state.size.hinge_count, hysteresis_args(state, params));
}

void settle_anchors(State& state, const Params& params)
{
    settle_friction(state, params);
    settle_hysteresis(state, params);
}

}  // namespace selvage
