#pragma once
#include <string_view>
#include <vector>

#include "host/solver/state/state.hpp"

namespace selvage {

/// Copies of the fields that carry the past from step to step: the KEPT lines of kernels/fields.def.
struct Snapshot {
#define KEPT(name, reason) std::vector<name##_type> name;
#include "kernels/fields.def"
};

/// Calls visit(name, field) for each of these fields of a state or of a snapshot.
template <class Fields, class Visit>
void visit_kept(Fields& fields, const Visit& visit)
{
#define KEPT(name, reason) visit(std::string_view(#name), fields.name);
#include "kernels/fields.def"
}

/// Calls visit(name, field, info) for each field of a state that the last look at contacts has filled: the FOUND lines.
template <class AnyState, class Visit>
void visit_found(AnyState& state, const Visit& visit)
{
#define FOUND(name, reason) visit(std::string_view(#name), state.name, field_info(Field::name));
#include "kernels/fields.def"
}

/// Copies the fields to a snapshot, whose memory is used again.
void keep(const State& state, Snapshot& snapshot);

/// Copies them back. @param snapshot  of the same state
void restore(State& state, const Snapshot& snapshot);

}  // namespace selvage
