#pragma once
#include <cstddef>
#include <vector>

namespace selvage {

/// What is done to a chunk before it is stored, as HDF5 numbers it.
enum Hdf5Filter { deflate_filter = 1, shuffle_filter = 2 };

inline bool is_known_filter(int filter) { return filter >= deflate_filter && filter <= shuffle_filter; }

/// Undoes filters, the last one first.
/// @param filters       as they were applied; known ones
/// @param number_bytes  of each number, for the shuffle filter
/// @param size          of the chunk without filters [bytes]; never more is allocated
/// @throws std::runtime_error if the bytes do not give a chunk of that size
std::vector<unsigned char> unfiltered(std::vector<unsigned char> bytes, const std::vector<int>& filters,
                                      std::size_t number_bytes, std::size_t size);

}  // namespace selvage
