#pragma once
#include <functional>
#include <string>
#include <vector>

#include "validation/fuzz/mutation.hpp"

namespace selvage {

/// A reader of files under test.
struct FuzzTarget {
    std::string name;
    std::string file_name;            ///< Under which an input is stored.
    std::vector<std::string> corpus;  ///< Whole inputs.
    bool binary = false;              ///< Changed as bytes, not as text.
    /// Reads the file. InputError is what faulty input shall give; anything else that is thrown is a fault.
    std::function<void(const std::string& path)> read;
    /// Gives a changed input its checksum, for half of them; null where there is none.
    std::function<void(std::string& input)> seal = nullptr;
};

/// Returns all targets.
/// @param folder  an empty one, for files that inputs need beside them
std::vector<FuzzTarget> fuzz_targets(const std::string& folder);

}  // namespace selvage
