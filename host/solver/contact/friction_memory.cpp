#include "host/solver/contact/friction_memory.hpp"

#include <algorithm>

namespace selvage {

bool is_ordered(const FrictionMemory& memory)
{
    return std::adjacent_find(memory.begin(), memory.end(), [](const PairFriction& a, const PairFriction& b) {
               return a.pair >= b.pair;
           }) == memory.end();
}

PackedFriction pack(const FrictionMemory& memory)
{
    PackedFriction packed;
    for (const PairFriction& of : memory) {
        packed.keys.push_back(of.pair.edges);
        packed.keys.insert(packed.keys.end(), of.pair.corner.begin(), of.pair.corner.end());
        packed.values.insert(packed.values.end(), of.weight.begin(), of.weight.end());
        packed.values.insert(packed.values.end(), of.normal.begin(), of.normal.end());
        packed.values.insert(packed.values.end(), of.bristle.begin(), of.bristle.end());
        packed.values.push_back(of.limit);
    }
    return packed;
}

std::optional<FrictionMemory> unpack(const PackedFriction& packed)
{
    constexpr std::size_t ints = PackedFriction::keys_per_pair, reals = PackedFriction::values_per_pair;
    const std::size_t count = packed.keys.size() / ints;
    if (packed.keys.size() != ints * count || packed.values.size() != reals * count) return std::nullopt;
    FrictionMemory memory(count);
    for (std::size_t k = 0; k < count; ++k) {
        const int* key = packed.keys.data() + ints * k;
        const double* value = packed.values.data() + reals * k;
        if (key[0] != 0 && key[0] != 1) return std::nullopt;
        PairFriction& of = memory[k];
        of.pair.edges = key[0] == 1;
        std::copy_n(key + 1, 4, of.pair.corner.begin());
        std::copy_n(value, 4, of.weight.begin());
        std::copy_n(value + 4, 3, of.normal.begin());
        std::copy_n(value + 7, 3, of.bristle.begin());
        of.limit = value[10];
    }
    if (!is_ordered(memory)) return std::nullopt;
    return memory;
}

}  // namespace selvage
