#include "host/solver/terms/cloth_state.hpp"

#include "host/model/cloth_model.hpp"
#include "host/parallel/trace.hpp"
#include "host/solver/state/hysteresis.hpp"
#include "host/solver/state/plate.hpp"
#include "host/solver/state/rest_state.hpp"
#include "host/solver/terms/terms.hpp"
#include "host/solver/terms/velocity_filters.hpp"

namespace selvage {

FieldSet required_fields(const Params& params)
{
    FieldSet fields = field_set({Field::pos, Field::vel, Field::mass, Field::inv_mass, Field::force});
    for (const Term& term : all_terms())
        if (term.is_active(params)) fields |= term.fields;
    for (const VelocityFilter& rule : all_velocity_filters())
        if (rule.is_active(params)) fields |= rule.fields;
#define GATHER_FIELDS(kind, corners)                  \
    if (fields[std::size_t(Field::kind##_force)]) {   \
        fields.set(std::size_t(Field::kind##_slots)); \
        fields.set(std::size_t(Field::kind##_slot));  \
    }
    GATHERED_KINDS(GATHER_FIELDS)
#undef GATHER_FIELDS
    return fields;
}

SpringChoice springs_of(const Params& params)
{
    return {params.spring.scale > 0, params.spring.bend_scale > 0, params.spring.elastic_scale > 0};
}

State make_state(const Topology& topology, const Cloth& cloth, const FabricTable& fabrics, const Params& params,
                 const std::vector<Vec3>& positions, const std::vector<Vec3>& velocities)
{
    const TraceScope scope("state");
    const FieldSet fields = required_fields(params);
    const bool plated = fields[std::size_t(Field::coupling_rigidity)];
    const PlateMatrix plate = plated ? make_plate(topology, cloth, fabrics) : PlateMatrix{};
    State state(topology_sizes(topology, int(fabrics.size()), plate.entries()), fields);
    fill_state(state, topology, cloth, fabrics, positions, velocities);
    if (plated) fill_plate(state, plate);
    if (!state.hinge_hysteresis.empty()) fill_hysteresis(state, topology, cloth, fabrics);
    return state;
}

}  // namespace selvage
