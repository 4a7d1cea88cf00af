#include "host/solver/terms/face_air.hpp"

#include "host/parallel/launch.hpp"
#include "host/solver/terms/bound_args.hpp"
#include "host/solver/terms/traffic.hpp"
#include "kernels/stages/face_air.h"

namespace selvage {

void find_face_air(State& state)
{
    face_air_args a;
    a.size = state.size;
    face_air_FIELDS(BIND_FIELD, BIND_FIELD);
    launch<face_air_of>(state.size.face_count, a);
}

std::size_t face_air_bytes(const State& state)
{
    return pass_bytes(state, {Field::pos, Field::face_vertex, Field::face_air});
}

}  // namespace selvage
