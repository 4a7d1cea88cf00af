#include "host/solver/state/state.hpp"

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

FieldSet field_set(std::initializer_list<Field> fields)
{
    FieldSet set;
    for (Field field : fields) set.set(std::size_t(field));
    return set;
}

int bytes_per_item(const FieldSet& fields, std::string_view kind)
{
    int bytes = 0;
    for (std::size_t f = 0; f < fields.size(); ++f)
        if (fields[f] && field_info(Field(f)).per == kind) bytes += field_info(Field(f)).bytes_per_item;
    return bytes;
}

State::State(const mesh_sizes& sizes, const FieldSet& wanted_fields) : size(sizes), wanted(wanted_fields)
{
#define FIELD(type, name, per, components, unit, meaning) \
    if (wanted[std::size_t(Field::name)]) name.resize(std::size_t(components) * std::size_t(sizes.per##_stride));
#include "kernels/fields.def"
}

void State::set_pairs(int count)
{
    if (!wanted[std::size_t(Field::pair_vertex)]) return;
    size.pair_count = count;
    size.pair_slot_count = 4 * count;
    if (padded_stride(count) > size.pair_stride) {  // with room to spare: contacts come in ones and twos
        size.pair_stride = padded_stride(count + count / 4);
        size.pair_slot_stride = padded_stride(4 * size.pair_stride);
    }
    const auto comes_and_goes = [](std::string_view per) { return per == "pair" || per == "pair_slot"; };
#define FIELD(type, name, per, components, unit, meaning)         \
    if (wanted[std::size_t(Field::name)] && comes_and_goes(#per)) \
        name.resize(std::size_t(components) * std::size_t(size.per##_stride));
#include "kernels/fields.def"
}

void State::set_body_points(int count)
{
    size.body_point_count = count;
    size.body_point_stride = padded_stride(count);
    body_point.resize(3 * std::size_t(size.body_point_stride));
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
    if (wanted[std::size_t(Field::name)])                 \
        total += std::size_t(components) * std::size_t(sizes.per##_stride) * sizeof(type);
#include "kernels/fields.def"
    return total;
}

}  // namespace selvage
