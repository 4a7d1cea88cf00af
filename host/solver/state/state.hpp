#pragma once
#include <bitset>
#include <cstddef>
#include <initializer_list>
#include <string_view>
#include <vector>

#include "kernels/terms.h"

namespace selvage {

/// One entry per FIELD line of kernels/fields.def, for use as an index or a set member.
enum class Field {
#define FIELD(type, name, per, components, unit, meaning) name,
#include "kernels/fields.def"
    count
};
using FieldSet = std::bitset<std::size_t(Field::count)>;

/// What a person or the planner wants to know about a field.
struct FieldInfo {
    std::string_view name, type, per, unit, meaning;
    int components;
    int bytes_per_item;  ///< components times the size of one.
};

/// Returns the description of a field from its line in kernels/fields.def.
const FieldInfo& field_info(Field field);

/// Returns the set of some fields.
FieldSet field_set(std::initializer_list<Field> fields);

/// Returns the bytes that those of some fields which belong to a kind of items have per item.
int bytes_per_item(const FieldSet& fields, std::string_view kind);

/// Items between two component planes: at least 48 away from every multiple of 128, so that
/// the planes of one field do not compete for the same cache sets (3 times faster at 16 k vertices).
constexpr int padded_stride(int count) { return count == 0 ? 0 : (count + 127) / 128 * 128 + 48; }

/// Which items take part in the steps at present: all, or those around vertices that are awake. See sleep.hpp.
struct AwakeItems {
    bool all = true;
    std::vector<int> vertex, face, hinge, stitch, spring;  ///< In ascending order; unused while all are awake.
    std::vector<char> is_awake;                            ///< Per vertex, likewise.
    double force_squared = 0;  ///< Sum of |f|^2 over the others, when they fell asleep [N^2].
};

/// Structure-of-arrays cloth state: component c of item i is at `name[c * stride + i]`.
/// A field outside the allocated set is empty and takes no memory.
struct State {
    mesh_sizes size{};
#define FIELD(type, name, per, components, unit, meaning) std::vector<type> name;
#include "kernels/fields.def"

    AwakeItems awake;
    FieldSet wanted;  ///< The fields that are in use.

    State() = default;
    State(const mesh_sizes& sizes, const FieldSet& wanted);  ///< Zero-fills the wanted fields.
    /// Makes room for so many pairs in contact; the contents of their fields are lost. Memory only ever grows.
    void set_pairs(int count);
    /// Makes room for the corners of bodies that pairs refer to.
    void set_body_points(int count);
    std::size_t bytes() const;  ///< Memory held by all fields.
};

/// Returns the memory that `wanted` would take for these sizes [bytes], without allocating it.
std::size_t field_bytes(const mesh_sizes& sizes, const FieldSet& wanted);

}  // namespace selvage
