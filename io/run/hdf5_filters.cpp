#include "io/run/hdf5_filters.hpp"

#include <stdexcept>

#include <zlib.h>

namespace selvage {
namespace {

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

}  // namespace

std::vector<unsigned char> unfiltered(std::vector<unsigned char> bytes, const std::vector<int>& filters,
                                      std::size_t number_bytes, std::size_t size)
{
    for (auto filter = filters.rbegin(); filter != filters.rend(); ++filter) {
        if (*filter == deflate_filter) bytes = inflated(bytes, size);
        if (*filter == shuffle_filter) bytes = unshuffled(bytes, number_bytes);
    }
    if (bytes.size() != size) throw std::runtime_error("damaged data: another number of bytes than their shape says");
    return bytes;
}

}  // namespace selvage
