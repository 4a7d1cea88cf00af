#pragma once
#include <string>
#include <vector>

namespace selvage {

/// The description that run.xdmf gives of the run.h5 beside it.
struct XdmfIndex {
    std::string hdf5_name;  ///< File name without folder.
    int point_count = 0;
    int triangle_count = 0;
    std::vector<double> times;  ///< One per frame [s].
};

/// Returns the XDMF 3 text of a temporal collection whose arrays are in the HDF5 file.
std::string xdmf_text(const XdmfIndex& index);

/// Writes the text under a temporary name and moves it into place.
/// @throws InputError if the folder cannot be written.
void write_xdmf(const std::string& path, const XdmfIndex& index);

}  // namespace selvage
