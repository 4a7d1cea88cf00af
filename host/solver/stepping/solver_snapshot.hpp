#pragma once
#include <vector>

#include "host/solver/state/snapshot.hpp"
#include "host/solver/stepping/integrator.hpp"

namespace selvage {

/// All that a step changes for good: the kept fields of the state, what friction remembers of pairs in contact, and
/// what the integrator remembers.
struct SolverSnapshot {
    Snapshot fields;
    FrictionMemory pairs;                    ///< Empty without contact of the cloth with itself.
    std::vector<std::vector<real>> history;  ///< In the order of Integrator::history.
    CrossingFlags crossings;                 ///< Of the cloth; see restore_crossings.
};

/// Copies it to a snapshot, whose memory is used again. @param integrator  null: none whose memory counts
void keep(const System& system, Integrator* integrator, SolverSnapshot& snapshot);

/// Copies it back; the contacts are then those of another place until they are looked for.
/// @param snapshot  of the same system and integrator
void restore(System& system, Integrator* integrator, const SolverSnapshot& snapshot);

/// Copies back what crosses. A retry goes on without what has come apart meanwhile; a step that is broken off is
/// repeated by a resumed run, which must find what it found at first.
void restore_crossings(System& system, const SolverSnapshot& snapshot);

}  // namespace selvage
