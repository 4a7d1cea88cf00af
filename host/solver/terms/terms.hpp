#pragma once
#include <span>
#include <string_view>

#include "host/parallel/items.hpp"
#include "host/solver/state/state.hpp"
#include "host/solver/terms/params.hpp"

namespace selvage {

enum class Nature { conservative, dissipative };
enum class ItemKind { vertex, face, hinge, stitch, spring, pair };

/// What the planner, the solver, the tests and the documentation know about one force term.
struct Term {
    std::string_view name;  ///< As listed in kernels/terms.h.
    ItemKind per;           ///< Kind of its items.
    Nature nature;
    FieldSet fields;                   ///< State arrays the term reads or adds to.
    int bytes_per_item;                ///< Bytes of those fields per item of its own kind.
    bool (*is_active)(const Params&);  ///< True if any strength is non-zero.
    int (*item_count)(const mesh_sizes&);
    void (*add_force)(State&, const Params&);  ///< Adds -dE/dx, or -dR/dv, to its items' forces [N].
    void (*add_stiffness)(State&, const Params&, bool projected);  ///< Adds d2E/dx2 [N/m], or d2R/dv2 [kg/s].
    double (*energy)(State&, const Params&);                       ///< Returns E [J], or R [W] of a dissipative term.
};

/// Returns all terms, in the order of kernels/terms.h.
std::span<const Term> all_terms();

/// The items of a kind that take part in the steps at present.
Items items_of(const State& state, ItemKind kind);

/// Returns the name of an item kind.
std::string_view kind_name(ItemKind kind);

/// Sets the accumulated forces of every allocated slot to zero.
void clear_forces(State& state);

/// Sets the accumulated stiffness of every allocated slot to zero.
void clear_stiffness(State& state);

/// Adds the diagonal blocks of the pairs in contact to the vertices' stiffness: kernels/stages/couple_pairs.h.
void add_pair_diagonals(State& state);

/// Sums the element forces at the vertices, in the fixed order of the gather lists: reproducible without atomics.
void gather_forces(State& state);

}  // namespace selvage
