#pragma once
#include <span>
#include <string_view>

#include "host/solver/terms/terms.hpp"

namespace selvage {

/// What the planner and the solver know about one velocity filter: a change of the state after a step that is no force.
struct VelocityFilter {
    std::string_view name;             ///< As listed in kernels/velocity_filters.h.
    ItemKind per;                      ///< Kind of its items.
    FieldSet fields;                   ///< State arrays that it reads or changes.
    int bytes_per_item;                ///< Bytes of those fields per item of its own kind.
    bool (*is_active)(const Params&);  ///< True if any strength is non-zero.
    int (*item_count)(const mesh_sizes&);
    void (*apply)(State&, const Params&, double dt);  ///< Ends a step of dt [s].
};

/// Returns all velocity filters, in the order of kernels/velocity_filters.h.
std::span<const VelocityFilter> all_velocity_filters();

}  // namespace selvage
