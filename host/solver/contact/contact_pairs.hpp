#pragma once
#include <vector>

#include "host/solver/contact/ccd_filter.hpp"
#include "host/solver/contact/contact_shares.hpp"
#include "host/solver/contact/friction_memory.hpp"
#include "host/solver/state/state.hpp"
#include "host/solver/terms/params.hpp"

namespace selvage {

/// The pairs in contact: writes them to the pair fields of the state, which the terms of contact and friction read, and
/// keeps what friction remembers of them from step to step.
///
/// Three orders meet here. Candidates come in any order, that of the tree's search. Pairs of the state stand in
/// ascending order of their keys, whatever the candidates' order, so that sums over pairs do not depend on the search.
/// The memory is a part of the pairs of the last settled step and stands in ascending order of keys too; so pairs and
/// memory are matched in one pass, and a pair finds its friction again though it has been left out of lists in between.
class ContactPairs {
public:
    /// @param gaps      must outlive this object
    /// @param area      rest area per particle [m^2]
    /// @param friction  Coulomb coefficient per particle [1]
    /// @param hardness  of contact, per particle, over that of its term [1]; empty: 1
    ContactPairs(const ContactGaps& gaps, ContactShares shares, std::vector<double> area, std::vector<double> friction,
                 std::vector<double> hardness = {});

    /// Writes pairs to the state, with what friction remembers of them. Areas are those at state.pos. Pairs that
    /// friction remembers are among them wherever they are now, so that the friction of a step depends on no search.
    /// @param bodies     where their corners are
    /// @param near       the pairs that may be in contact, in any order
    /// @param crossings  which of those that friction remembers are to be left out
    void list(State& state, const TreeBodies& bodies, std::vector<PairCandidate> near,
              const CrossingFlags& crossings) const;

    /// Ends a step for friction: bristles slip, limits follow the normal forces, and both are remembered of those pairs
    /// whose limit is above zero.
    void settle(State& state, const Params& params);

    const FrictionMemory& memory() const { return memory_; }
    /// @throws std::invalid_argument if the memory is not in order
    void set_memory(FrictionMemory memory);

    std::size_t bytes() const
    {
        return shares_.bytes() + (area_.capacity() + friction_.capacity() + hardness_.capacity()) * sizeof(double) +
               memory_.capacity() * sizeof(PairFriction);
    }

private:
    std::vector<PairCandidate> with_friction(const std::vector<PairCandidate>& near,
                                             const CrossingFlags& crossings) const;
    double area_of(const PairCandidate& candidate, const StraightStep& at) const;
    double hardness_of(const PairCandidate& candidate) const;
    double friction_of(const PairKey& pair) const;
    void recall(State& state) const;
    void remember(State& state);
    void pass_on(State& state, int pair) const;

    const ContactGaps& gaps_;
    ContactShares shares_;
    std::vector<double> area_, friction_, hardness_;  // per particle
    FrictionMemory memory_;
};

/// Lists of which pairs of the state each particle is a corner. Called where pairs have been set from outside.
void list_pair_slots(State& state);

}  // namespace selvage
