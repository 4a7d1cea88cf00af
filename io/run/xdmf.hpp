#pragma once
#include <string>
#include <vector>

namespace selvage {

/// What run.xdmf says about the run.h5 beside it.
struct XdmfIndex {
    std::string hdf5_name;  ///< File name without folder.
    int point_count = 0;
    int triangle_count = 0;
    std::vector<double> times;  ///< One per frame [s].
};

/// The XDMF 3 text of a temporal collection whose heavy data lie in the HDF5 file.
std::string xdmf_text(const XdmfIndex& index);

/// Writes it through a temporary name.
/// @throws InputError if the folder cannot be written.
void write_xdmf(const std::string& path, const XdmfIndex& index);

}  // namespace selvage
