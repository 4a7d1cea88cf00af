#pragma once
#include "host/solver/state/state.hpp"
#include "kernels/stages/couple_pairs.h"

namespace selvage {

/// What the stages over pairs in contact read of the state.
inline pair_list pair_list_of(const State& s)
{
    return {s.size,
            s.pair_vertex.data(),
            s.pair_weight.data(),
            s.pair_held_weight.empty() ? nullptr : s.pair_held_weight.data(),
            s.pair_stiffness.data(),
            s.pair_slots.data(),
            s.pair_slot.data()};
}

}  // namespace selvage
