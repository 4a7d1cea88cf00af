#include "host/solver/terms/cloth_state.hpp"

#include "host/parallel/trace.hpp"
#include "host/solver/state/hysteresis.hpp"
#include "host/solver/state/plate.hpp"
#include "host/solver/terms/terms.hpp"

namespace selvage {

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
