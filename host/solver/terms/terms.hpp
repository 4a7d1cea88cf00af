#pragma once
#include <span>
#include <string_view>

#include "host/parallel/items.hpp"
#include "host/solver/state/state.hpp"
#include "host/solver/terms/energy_family.hpp"
#include "host/solver/terms/params.hpp"

namespace selvage {

enum class Nature { conservative, dissipative };
enum class ItemKind { vertex, face, hinge, stitch, spring, pair };

/// The items of a kind that take part in the steps at present: those awake.
Items items_of(const State& state, ItemKind kind);

/// All items of a kind, those asleep included.
Items all_items_of(const State& state, ItemKind kind);

/// What the planner, the solver, the tests and the documentation know about one force term.
struct Term {
    std::string_view name;  ///< As listed in kernels/terms.h.
    ItemKind per;           ///< Kind of its items.
    Nature nature;
    EnergyFamily family;               ///< That its energy counts to.
    FieldSet fields;                   ///< State arrays the term reads or adds to.
    int bytes_per_item;                ///< Bytes of those fields per item of its own kind.
    bool (*is_active)(const Params&);  ///< True if any strength is non-zero.
    int (*item_count)(const mesh_sizes&);
    void (*add_force)(State&, const Params&);  ///< Adds -dE/dx, or -dR/dv, to its items' forces [N].
    void (*add_stiffness)(State&, const Params&, bool projected);  ///< Adds d2E/dx2 [N/m], or d2R/dv2 [kg/s].
    /// Returns E of some items [J], or R of a dissipative term [W]. Of the state it writes only what the term's stage
    /// derives from the positions.
    double (*energy_over)(State&, const Params&, const Items&);

    /// The same of all items that are awake.
    double energy(State& state, const Params& params) const { return energy_over(state, params, items_of(state, per)); }
};

/// Returns all terms, in the order of kernels/terms.h.
std::span<const Term> all_terms();

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
