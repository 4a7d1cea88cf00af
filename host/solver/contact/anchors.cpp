#include "host/solver/contact/anchors.hpp"

#include "host/parallel/launch.hpp"
#include "host/solver/contact/body_contact.hpp"
#include "kernels/stages/settle_hysteresis.h"

namespace selvage {

void settle_hysteresis(State& state, const Params& params)
{
    if (state.hinge_anchor.empty()) return;
    settle_hysteresis_args args{};
    args.hysteresis.size = state.size;
    args.hysteresis.pos = state.pos.data();
    args.hysteresis.hinge_vertex = state.hinge_vertex.data();
    args.hysteresis.hinge_rest_sine = state.hinge_rest_sine.data();
    args.hysteresis.hinge_width = state.hinge_width.data();
    args.hysteresis.hinge_anchor = state.hinge_anchor.data();
    args.hysteresis.stick_curvature = params.bending_hysteresis.stick_curvature;
    args.anchor = state.hinge_anchor.data();
    launch<settle_hysteresis_hinge>(state.size.hinge_count, args);
}

void settle_anchors(State& state, const Params& params)
{
    settle_friction(state, params);
    settle_hysteresis(state, params);
}

}  // namespace selvage
