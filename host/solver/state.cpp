#include "host/solver/state.hpp"

namespace selvage {

const FieldInfo& field_info(Field field)
{
    static const FieldInfo infos[] = {
#define FIELD(type, name, per, components, unit, meaning) \
    {#name, #type, #per, unit, meaning, components, int(components * sizeof(type))},
#include "kernels/fields.def"
    };
    return infos[std::size_t(field)];
}

State::State(const mesh_sizes& sizes, const FieldSet& wanted) : size(sizes)
{
#define FIELD(type, name, per, components, unit, meaning) \
    if (wanted[std::size_t(Field::name)]) name.resize(std::size_t(components) * std::size_t(sizes.per##_stride));
#include "kernels/fields.def"
}

std::size_t State::bytes() const
{
    std::size_t total = 0;
#define FIELD(type, name, per, components, unit, meaning) total += name.size() * sizeof(type);
#include "kernels/fields.def"
    return total;
}

std::size_t field_bytes(const mesh_sizes& sizes, const FieldSet& wanted)
{
    std::size_t total = 0;
#define FIELD(type, name, per, components, unit, meaning) \
    if (wanted[std::size_t(Field::name)]) total += std::size_t(components) * std::size_t(sizes.per##_stride) * sizeof(type);
#include "kernels/fields.def"
    return total;
}

}  // namespace selvage
