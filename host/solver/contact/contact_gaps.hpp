#pragma once
#include <vector>

#include "host/collision/cloth_tree.hpp"
#include "host/model/cloth_model.hpp"
#include "host/solver/state/topology.hpp"

namespace selvage {

/// Numbers the pieces of cloth that hang together, by faces and by seams; per vertex of the cloth.
std::vector<int> pieces_of(const Cloth& cloth);

/// Distances at which contact of the cloth sets in, pair by pair [m]. What is special about one place, be it a thick
/// fabric, a fine mesh or a narrow triangle, counts for the pairs there only.
class ContactGaps {
public:
    /// @param gap  of all pairs of cloth
    explicit ContactGaps(double gap) : largest_(gap) {}

    /// As far as the fabrics are thick, each side with its half, or `least` if that is more [m]; but well below the
    /// length of the edges of that piece of cloth. What lies near each other at rest, as the sides of a narrow triangle
    /// do, must not press on each other, and neighbours across a seam must not either.
    ContactGaps(const Topology& topology, const Cloth& cloth, const FabricTable& fabrics, double least);

    double largest() const { return largest_; }  ///< Of any pair of cloth.
    double largest_of_bodies() const;            ///< Of any pair with a body, at most that of cloth.

    /// Of a pair of cloth. Of one with a body, what the cloth would have with its like.
    double of_cloth(const PairCandidate& candidate) const { return wanted_.empty() ? largest_ : local(candidate); }

    /// Where the forces of a pair set in; 0 for a vertex of the cloth and a face of a body, which the body's contact
    /// plane presses on already.
    double of(const PairCandidate& candidate) const;

    std::size_t bytes() const
    {
        return (wanted_.capacity() + room_.capacity()) * sizeof(double) + rest_.capacity() * sizeof(Vec2) +
               (piece_.capacity() + panel_.capacity()) * sizeof(int);
    }

private:
    double local(const PairCandidate& candidate) const;
    double rest_distance(const PairCandidate& candidate) const;

    double largest_;
    // Per particle; empty if all pairs are alike.
    std::vector<double> wanted_;  // by thickness and edges [m]
    std::vector<double> room_;    // least height of the triangles around it [m]
    std::vector<int> piece_;      // of cloth that hangs together, by faces and seams
    std::vector<int> panel_;      // -1: it is a vertex of several, or several of one
    std::vector<Vec2> rest_;      // in its panel [m]
};

}  // namespace selvage
