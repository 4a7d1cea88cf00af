#include "io/run/hdf5_id.hpp"

#include <stdexcept>
#include <string>

namespace selvage {

std::string hdf5_error()
{
    std::string text;
    const H5E_walk2_t keep_last = [](unsigned, const H5E_error2_t* error, void* target) -> herr_t {
        if (error->desc) *static_cast<std::string*>(target) = error->desc;
        return 0;
    };
    H5Ewalk2(H5E_DEFAULT, H5E_WALK_DOWNWARD, keep_last, &text);
    return text.empty() ? "an error without a message" : text;
}

Hdf5Id::Hdf5Id(hid_t id, Closer closer, std::string_view what) : id_(id), closer_(closer)
{
    require_hdf5(id < 0 ? -1 : 0, what);
}

Hdf5Id& Hdf5Id::operator=(Hdf5Id&& other) noexcept
{
    std::swap(id_, other.id_);
    std::swap(closer_, other.closer_);
    return *this;
}

void Hdf5Id::reset()
{
    if (id_ >= 0) closer_(id_);
    id_ = H5I_INVALID_HID;
}

void require_hdf5(herr_t status, std::string_view what)
{
    if (status < 0) throw std::runtime_error("HDF5: " + std::string(what) + ": " + hdf5_error());
}

}  // namespace selvage
