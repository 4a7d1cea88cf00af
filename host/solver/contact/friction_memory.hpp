#pragma once
#include <array>
#include <compare>
#include <optional>
#include <vector>

#include "host/collision/cloth_tree.hpp"
#include "kernels/portable.h"

namespace selvage {

/// What a pair is known by from step to step: its kind and the four corners as PairCandidate has them. Pairs of a
/// vertex and a face come before pairs of edges.
struct PairKey {
    bool edges = false;
    std::array<int, 4> corner{};

    auto operator<=>(const PairKey&) const = default;
};

inline PairKey key_of(const PairCandidate& candidate) { return {candidate.edges, candidate.corner}; }

/// What friction remembers of a pair from the end of a step; see kernels/terms/cloth_friction.h.
struct PairFriction {
    PairKey pair;
    std::array<real, 4> weight{};   ///< Of the corners in the way between the closest points [1].
    std::array<real, 3> normal{};   ///< Unit vector from the second side to the first [1].
    std::array<real, 3> bristle{};  ///< Elastic displacement of friction [m].
    real limit = 0;                 ///< Largest friction force, > 0 [N].

    bool operator==(const PairFriction&) const = default;
};

/// Of all pairs that friction acted on, in ascending order of their keys.
using FrictionMemory = std::vector<PairFriction>;

/// True if keys ascend strictly.
bool is_ordered(const FrictionMemory& memory);

/// A memory as arrays of numbers, for checkpoints.
struct PackedFriction {
    static constexpr int keys_per_pair = 5, values_per_pair = 11;

    std::vector<int> keys;       ///< Per pair: 1 for edges and 0 for a vertex and a face, then four corners.
    std::vector<double> values;  ///< Per pair: weight, normal, bristle, limit.
};

PackedFriction pack(const FrictionMemory& memory);

/// Returns what was packed, bit by bit; nothing if the arrays do not fit each other, a kind is neither 0 nor 1, or the
/// pairs are out of order.
std::optional<FrictionMemory> unpack(const PackedFriction& packed);

}  // namespace selvage
