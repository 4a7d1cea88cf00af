#include "io/run/hdf5_checks.hpp"

#include <algorithm>
#include <array>
#include <vector>

#include "io/run/hdf5_id.hpp"

namespace selvage {
namespace {

// The types that files of this program hold.
bool is_known_number(hid_t type)
{
    const std::array<hid_t, 4> known{H5T_STD_I32LE, H5T_STD_I64LE, H5T_IEEE_F32LE, H5T_IEEE_F64LE};
    return std::ranges::any_of(known, [&](hid_t other) { return H5Tequal(type, other) > 0; });
}

bool is_known_filter(H5Z_filter_t filter)
{
    return filter == H5Z_FILTER_DEFLATE || filter == H5Z_FILTER_SHUFFLE || filter == H5Z_FILTER_FLETCHER32;
}

// The filters of a dataset; false: others than those that run files use.
bool read_filters(hid_t properties, bool& compressed)
{
    const int count = H5Pget_nfilters(properties);
    for (int k = 0; k < count; ++k) {
        unsigned flags = 0;
        std::size_t value_count = 0;
        const H5Z_filter_t filter =
            H5Pget_filter2(properties, unsigned(k), &flags, &value_count, nullptr, 0, nullptr, nullptr);
        if (!is_known_filter(filter)) return false;
        compressed = compressed || filter == H5Z_FILTER_DEFLATE;
    }
    return count >= 0;
}

std::uintmax_t chunk_bytes(hid_t properties, std::size_t number_size)
{
    if (H5Pget_layout(properties) != H5D_CHUNKED) return 0;
    std::array<hsize_t, H5S_MAX_RANK> extent{};
    const int rank = H5Pget_chunk(properties, H5S_MAX_RANK, extent.data());
    std::uintmax_t bytes = number_size;
    for (int axis = 0; axis < rank; ++axis) bytes = saturated_product(bytes, extent[std::size_t(axis)]);
    return bytes;
}

std::string source_file(hid_t properties, std::size_t index)
{
    const ssize_t length = H5Pget_virtual_filename(properties, index, nullptr, 0);
    if (length < 0) return "?";
    std::vector<char> name(std::size_t(length) + 1);
    H5Pget_virtual_filename(properties, index, name.data(), name.size());
    return name.data();
}

}  // namespace

std::uintmax_t saturated_product(std::uintmax_t a, std::uintmax_t b)
{
    return a != 0 && b > UINTMAX_MAX / a ? UINTMAX_MAX : a * b;
}

void confine_hdf5()
{
    static const bool done = [] {
        H5Lunregister(H5L_TYPE_EXTERNAL);
        H5PLset_loading_state(0);
        return true;
    }();
    static_cast<void>(done);
}

Hdf5Fault check_link(hid_t file, const std::string& path)
{
    H5L_info_t info{};
    if (H5Lget_info(file, path.c_str(), &info, H5P_DEFAULT) < 0) return {};  // none: opening it tells
    if (info.type == H5L_TYPE_HARD || info.type == H5L_TYPE_SOFT) return {};
    return {"a link that leads out of the file", "an object of the file itself"};
}

Hdf5Fault check_data_place(hid_t dataset)
{
    const Hdf5Id properties(H5Dget_create_plist(dataset), H5Pclose, "dataset properties");
    if (H5Pget_external_count(properties) > 0)
        return {"external storage: its data lie in another file", "data in the file itself"};
    if (H5Pget_layout(properties) != H5D_VIRTUAL) return {};
    std::size_t sources = 0;
    require_hdf5(H5Pget_virtual_count(properties, &sources), "virtual dataset");
    for (std::size_t k = 0; k < sources; ++k)
        if (const std::string name = source_file(properties, k); name != ".")
            return {"a virtual dataset with data of `" + name + "`", "data in the file itself"};
    return {};
}

Hdf5Fault check_dataset(hid_t dataset, std::uintmax_t bytes, std::uintmax_t file_size, std::uintmax_t most)
{
    const Hdf5Id type(H5Dget_type(dataset), H5Tclose, "dataset type");
    if (!is_known_number(type)) return {"another type of data", "numbers of 32 or 64 bits, little-endian"};
    const Hdf5Id properties(H5Dget_create_plist(dataset), H5Pclose, "dataset properties");
    bool compressed = false;
    if (!read_filters(properties, compressed)) return {"an unknown filter", "the filters deflate, shuffle, fletcher32"};
    if (H5Pget_layout(properties) == H5D_VIRTUAL) return {"a virtual dataset", "data of its own"};
    const std::uintmax_t stored = std::min<std::uintmax_t>(H5Dget_storage_size(dataset), file_size);
    most = std::min(most, saturated_product(stored, compressed ? most_expansion : 1));
    const std::uintmax_t needed = std::max(bytes, bytes > 0 ? chunk_bytes(properties, H5Tget_size(type)) : 0);
    if (needed <= most) return {};
    return {std::to_string(needed) + " bytes of values in " + std::to_string(stored) + " stored bytes",
            "at most " + std::to_string(most) + " bytes"};
}

}  // namespace selvage
