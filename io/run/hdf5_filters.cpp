#include "io/run/hdf5_filters.hpp"

#include <algorithm>
#include <cstdint>
#include <stdexcept>

#include <zlib.h>

namespace selvage {
namespace {

constexpr std::size_t checksum_bytes = 4;

std::vector<unsigned char> inflated(const std::vector<unsigned char>& bytes, std::size_t most)
{
    std::vector<unsigned char> result(most);
    z_stream stream{};
    stream.next_in = const_cast<unsigned char*>(bytes.data());
    stream.avail_in = uInt(bytes.size());
    stream.next_out = result.data();
    stream.avail_out = uInt(most);
    if (inflateInit(&stream) != Z_OK) throw std::runtime_error("zlib cannot be started");
    const int status = inflate(&stream, Z_FINISH);
    result.resize(most - stream.avail_out);
    inflateEnd(&stream);
    if (status != Z_STREAM_END) throw std::runtime_error("damaged data: they cannot be decompressed");
    return result;
}

// Bytes lie by their place in a number: all first ones, all second ones ... What is left over follows.
std::vector<unsigned char> unshuffled(const std::vector<unsigned char>& bytes, std::size_t number_bytes)
{
    const std::size_t count = bytes.size() / number_bytes;
    std::vector<unsigned char> result = bytes;
    for (std::size_t k = 0; k < number_bytes; ++k)
        for (std::size_t i = 0; i < count; ++i) result[i * number_bytes + k] = bytes[k * count + i];
    return result;
}

// Fletcher's checksum over big-endian words of 16 bits.
std::uint32_t checksum(const unsigned char* bytes, std::size_t size)
{
    constexpr std::size_t words_at_once = 360;  // so many cannot overflow 32 bits
    const auto fold = [](std::uint32_t sum) { return (sum & 0xffff) + (sum >> 16); };
    std::uint32_t first = 0, second = 0;
    for (std::size_t at = 0; at + 1 < size;) {
        for (std::size_t k = 0; k < words_at_once && at + 1 < size; ++k, at += 2) {
            first += std::uint32_t(bytes[at]) << 8 | bytes[at + 1];
            second += first;
        }
        first = fold(first);
        second = fold(second);
    }
    if (size % 2 == 1) {
        first += std::uint32_t(bytes[size - 1]) << 8;
        second += first;
        first = fold(first);
        second = fold(second);
    }
    return fold(second) << 16 | fold(first);
}

void take_checksum(std::vector<unsigned char>& bytes)
{
    if (bytes.size() < checksum_bytes) throw std::runtime_error("damaged data: no checksum");
    std::uint32_t stored = 0;
    for (std::size_t k = checksum_bytes; k > 0; --k)
        stored = stored << 8 | bytes[bytes.size() - checksum_bytes + k - 1];
    bytes.resize(bytes.size() - checksum_bytes);
    if (stored != checksum(bytes.data(), bytes.size()))
        throw std::runtime_error("damaged data: their checksum differs");
}

}  // namespace

std::vector<unsigned char> unfiltered(std::vector<unsigned char> bytes, const std::vector<int>& filters,
                                      std::size_t number_bytes, std::size_t size)
{
    for (auto filter = filters.rbegin(); filter != filters.rend(); ++filter) {
        if (*filter == checksum_filter) take_checksum(bytes);
        if (*filter == deflate_filter) bytes = inflated(bytes, size + checksum_bytes);
        if (*filter == shuffle_filter) bytes = unshuffled(bytes, number_bytes);
    }
    if (bytes.size() != size) throw std::runtime_error("damaged data: another number of bytes than their shape says");
    return bytes;
}

}  // namespace selvage
