#include "kernels/stages/settle_friction.h"
#include "host/parallel/launch.hpp"
#include "host/solver/contact/body_contact.hpp"
#include "kernels/stages/hold_friction.h"

namespace selvage {

void settle_friction(State& state, const Params& params)
{
    if (state.friction_anchor.empty()) return;
    settle_friction_args args{};
    args.contact.size = state.size;
    args.contact.pos = state.pos.data();
    args.contact.contact_normal = state.contact_normal.data();
    args.contact.contact_offset = state.contact_offset.data();
    args.contact.contact_area = state.contact_area.data();
    args.contact.stiffness = params.body_contact.stiffness;
    args.contact.gap = params.body_contact.gap;
    args.repulsion.size = state.size;
    args.repulsion.pos = state.pos.data();
    args.repulsion.contact_normal = state.contact_normal.data();
    args.repulsion.contact_offset = state.contact_offset.data();
    args.repulsion.contact_area = state.contact_area.data();
    args.repulsion.stiffness = params.body_repulsion.stiffness;
    args.repulsion.gap = params.body_repulsion.gap;
    args.friction = state.contact_friction.data();
    args.anchor = state.friction_anchor.data();
    args.limit = state.friction_limit.data();
    args.stick_distance = params.friction.stick_distance;
    launch<settle_friction_vertex>(state.size.vertex_count, args);
}

void hold_by_friction(State& state, const Params& params)
{
    if (state.friction_anchor.empty()) return;
    launch<hold_friction_vertex>(
        state.size.vertex_count,
        hold_friction_args{state.pos.data(), state.vel.data(), state.force.data(), state.contact_normal.data(),
                           state.friction_limit.data(), state.friction_anchor.data(), params.friction.stick_distance,
                           state.size.vertex_stride});
}

}  // namespace selvage
