#include "host/solver/state/snapshot.hpp"

namespace selvage {

void keep(const State& state, Snapshot& snapshot)
{
#define KEPT(name, reason) snapshot.name = state.name;
#include "kernels/fields.def"
}

void restore(State& state, const Snapshot& snapshot)
{
#define KEPT(name, reason) state.name = snapshot.name;
#include "kernels/fields.def"
}

}  // namespace selvage
