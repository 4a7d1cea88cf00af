#pragma once
#include <map>
#include <string>
#include <vector>

namespace selvage {

/// Named arrays from which a run goes on; names hold no slash.
struct Checkpoint {
    std::map<std::string, std::vector<double>> reals;
    std::map<std::string, std::vector<int>> integers;
    std::map<std::string, std::string> words;  ///< Without zero bytes.
};

/// Writes the checkpoint under a temporary name, brings it to the disk and renames it. The file is HDF5, followed by a
/// checksum over all of it.
/// @throws InputError if the folder cannot be written.
void write_checkpoint(const std::string& path, const Checkpoint& checkpoint);

/// Reads a checkpoint; the arrays' bits are as written.
/// @throws InputError if the file is missing, damaged in any bit, or something else.
Checkpoint read_checkpoint(const std::string& path);

}  // namespace selvage
