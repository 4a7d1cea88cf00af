#pragma once
#include <string>
#include <string_view>
#include <utility>

#include <hdf5.h>

namespace selvage {

/// Owns one HDF5 identifier and closes it. HDF5 is not thread-safe, so only one thread at a time may use it.
class Hdf5Id {
public:
    using Closer = herr_t (*)(hid_t);

    Hdf5Id() = default;
    /// @throws std::runtime_error with HDF5's own message and `what` if `id` is negative.
    Hdf5Id(hid_t id, Closer closer, std::string_view what);
    Hdf5Id(Hdf5Id&& other) noexcept { *this = std::move(other); }
    Hdf5Id& operator=(Hdf5Id&& other) noexcept;
    ~Hdf5Id() { reset(); }

    operator hid_t() const { return id_; }
    void reset();

private:
    hid_t id_ = H5I_INVALID_HID;
    Closer closer_ = nullptr;
};

/// The message of the deepest error of the last call that failed.
std::string hdf5_error();

/// @throws std::runtime_error with HDF5's own message and `what` if `status` is negative.
void require_hdf5(herr_t status, std::string_view what);

}  // namespace selvage
