#pragma once
#include <cstdint>
#include <string>
#include <string_view>

namespace selvage {

/// A hash of 64 bits that tells contents apart (FNV-1a: Fowler, Noll and Vo 1991). Changing any one byte changes it;
/// it is no protection against somebody who looks for two contents with the same hash.
class ContentHash {
public:
    void add(std::string_view bytes)
    {
        for (const char byte : bytes) value_ = (value_ ^ std::uint8_t(byte)) * 1099511628211ull;
    }
    std::uint64_t value() const { return value_; }
    std::string text() const;  ///< 16 hexadecimal digits.

private:
    std::uint64_t value_ = 14695981039346656037ull;
};

}  // namespace selvage
