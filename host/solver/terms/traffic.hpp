#pragma once
#include <cstddef>
#include <initializer_list>

#include "host/solver/state/state.hpp"
#include "host/solver/terms/terms.hpp"

namespace selvage {

/// The three functions of a force term.
enum class TermPart { value, force, stiffness };

// The bytes that one call must move between memory and a processor whose caches hold nothing at first and lose nothing
// during a pass: every array that a pass reads or writes counts once for each of the two, whole and without padding.
// Scalars of the linear solver are doubles.

/// Of one pass over whole fields of a state; what is not allocated counts nothing.
std::size_t pass_bytes(const State& state, std::initializer_list<Field> fields);

/// Of one function of a term, by its field list: fields of its own kind, vertex fields once for every vertex that its
/// items touch, and the accumulators of that part read and written. 0 for the stiffness of a term that has none.
std::size_t term_bytes(const Term& term, const State& state, TermPart part);

std::size_t clear_forces_bytes(const State& state);     ///< Written.
std::size_t clear_stiffness_bytes(const State& state);  ///< Written.
std::size_t gather_list_bytes(const State& state);      ///< Which element and corner adds to which vertex, read.
std::size_t gather_bytes(const State& state);  ///< Slot lists, element forces and the forces they are added to.
std::size_t settle_friction_bytes(const State& state);
std::size_t settle_hysteresis_bytes(const State& state);
/// Of the query's arguments: positions, normals, offsets and bodies. What a search reads of the body is not counted.
std::size_t body_query_bytes(const State& state);

}  // namespace selvage
