#pragma once
#include <cstdint>
#include <string>

#include <hdf5.h>

namespace selvage {

/// Switches off what lets a file that is read act outside itself: external links and filters loaded from elsewhere.
void confine_hdf5();

/// A fault of an object in a file, as InputError words it; both empty: none.
struct Hdf5Fault {
    std::string found, expected;
    explicit operator bool() const { return !expected.empty(); }
};

/// Finds out whether a link leads out of its file; the part of the path before its last slash has been checked.
Hdf5Fault check_link(hid_t file, const std::string& path);

/// Finds out whether the data of a dataset, which may be virtual, lie in other files.
Hdf5Fault check_data_place(hid_t dataset);

/// The product of two numbers, or the largest one if it is larger than that.
std::uintmax_t saturated_product(std::uintmax_t a, std::uintmax_t b);

/// What deflate can make of a byte (zlib's technical details give 1032 : 1 as its limit).
inline constexpr std::uintmax_t most_expansion = 1032;

/// All arrays read from a file hold at most so many times its bytes. Runs of sheets that lie still come to about 70,
/// for their meshes are regular; a file of 0.1 MB may take 26 MB.
inline constexpr std::uintmax_t most_file_expansion = 256;

/// Finds out whether so many bytes of a dataset can be read without more memory than its stored bytes account for:
/// they, and one of its chunks, may be at most most_expansion times the stored bytes, or just these when nothing is
/// compressed. Refuses number types and filters that run files and checkpoints do not use, and virtual datasets.
/// @param bytes      asked for
/// @param file_size  [bytes]
/// @param most       bytes that may still be read from the file
Hdf5Fault check_dataset(hid_t dataset, std::uintmax_t bytes, std::uintmax_t file_size, std::uintmax_t most);

}  // namespace selvage
