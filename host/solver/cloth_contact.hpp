#pragma once
#include <vector>

#include "host/collision/ccd.hpp"
#include "host/collision/cloth_tree.hpp"
#include "host/solver/params.hpp"
#include "host/solver/state.hpp"
#include "host/solver/topology.hpp"

namespace selvage {

/// What a run reports of contact between cloth and cloth.
struct ClothContactCounts {
    long long looks = 0;            ///< Times that pairs were looked for.
    long long shortened = 0;        ///< Moves that were cut since something would have been passed through.
};

/// Contact of the cloth with itself: keeps the pairs in the state's fields up to date and every move free of
/// crossings. Cloth that starts free of intersections stays so: whatever moves the cloth asks `clear_way` first.
class ClothContact {
public:
    /// @param gap       distance at which contact sets in [m]
    /// @param friction  per particle [1]; empty: none
    ClothContact(const Topology& topology, const Cloth& cloth, double gap, std::vector<double> friction);

    /// Lists the pairs that are in contact at state.pos.
    void update(State& state);

    /// Shortens a move until its straight way is free: no pair comes nearer than a tenth of its distance. Also lists
    /// all pairs that are in contact somewhere on the way.
    /// @param move     planes like pos [m]
    /// @param uniform  true: the whole move is scaled; false: only the vertices around what would be hit are held back
    void clear_way(State& state, std::vector<real>& move, bool uniform);

    /// Ends a step for friction: bristles slip, limits follow the normal forces.
    void settle(State& state, const Params& params);

    /// The bristles of friction, for retries and checkpoints: thirteen numbers per pair.
    std::vector<real>& memory() { return memory_; }
    const std::vector<real>& memory() const { return memory_; }

    double gap() const { return gap_; }
    const ClothContactCounts& counts() const { return counts_; }
    const TreeCounts& tree_counts() const { return tree_.counts(); }
    std::size_t bytes() const;

private:
    struct Look {                    // at one candidate
        float distance = 0;          // a lower bound; exact where the candidate may matter [m]
        float approach = 0;          // an upper bound, likewise [m]
        bool near = false;           // it may matter on this way
    };

    PairCorners corners_at(const PairCandidate& candidate, const double* plane, int stride) const;
    void look_at_all(const State& state, const std::vector<real>* move, bool afresh);
    void measure_ways(const State& state, const std::vector<real>* move);
    bool hold_back(const State& state, std::vector<real>& move, int round, bool uniform);
    void list_pairs(State& state);
    void recall(State& state);
    double area_of(const State& state, const PairCandidate& candidate) const;

    double gap_;
    std::vector<double> friction_, area_;          // per particle
    ClothTree tree_;
    std::vector<Look> looks_;                      // per candidate
    std::vector<Vec3> seen_;                       // per particle: where it was at the last look [m]
    std::vector<float> gone_, way_;                // per particle: how far it has gone since, and is to go [m]
    std::vector<char> held_;                       // per particle: held back in the last move
    std::vector<int> listed_;                      // candidates that are pairs now, in the pairs' order
    std::vector<real> memory_;
    ClothContactCounts counts_;
};

/// The surface of a cloth that a tree is built over, in the numbering of the topology's particles.
TreeSurface tree_surface(const Topology& topology, const Cloth& cloth);

}  // namespace selvage
