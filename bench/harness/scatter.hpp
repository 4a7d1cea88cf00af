#pragma once
#include <cstdint>

namespace selvage {

/// Returns a pseudo-random number in [-1, 1) that depends on the index only (Steele, Lea and Flood 2014, SplitMix64).
inline double scatter(std::uint64_t index)
{
    std::uint64_t bits = (index + 1) * 0x9e3779b97f4a7c15ull;
    bits = (bits ^ (bits >> 30)) * 0xbf58476d1ce4e5b9ull;
    bits = (bits ^ (bits >> 27)) * 0x94d049bb133111ebull;
    return double((bits ^ (bits >> 31)) >> 11) / 4503599627370496.0 - 1;
}

}  // namespace selvage
