#include "io/run/hdf5_file.hpp"

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <stdexcept>

#include "io/atomic_file.hpp"
#include "io/run/commit_driver.hpp"

namespace selvage {
namespace {

// HDF5 prints its error stack by default. Here the deepest error becomes part of the exception instead.
void silence_hdf5() { H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr); }

// An attribute takes at most 64 KiB, of which each text takes 16 bytes for the place where it is stored.
constexpr std::size_t most_attribute_texts = 4000;

Hdf5Id text_type()
{
    Hdf5Id type(H5Tcopy(H5T_C_S1), H5Tclose, "text type");
    require_hdf5(H5Tset_size(type, H5T_VARIABLE), "text type");
    require_hdf5(H5Tset_cset(type, H5T_CSET_UTF8), "text type");
    return type;
}

Hdf5Id simple_space(const std::vector<hsize_t>& shape, bool growing = false)
{
    std::vector<hsize_t> most = shape;
    if (growing) most.at(0) = H5S_UNLIMITED;
    return {H5Screate_simple(int(shape.size()), shape.data(), most.data()), H5Sclose, "data space"};
}

hid_t open_file(const std::string& path, Hdf5Access access)
{
    const Hdf5Id properties(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, "file access properties");
    // HDF5's default up to 1.14. Headers in the newer formats have checksums, which the order of writes breaks.
    require_hdf5(H5Pset_libver_bounds(properties, H5F_LIBVER_EARLIEST, H5F_LIBVER_LATEST), "versions of the format");
    use_commit_driver(properties);
    if (access == Hdf5Access::append) return H5Fopen(path.c_str(), H5F_ACC_RDWR, properties);
    return H5Fcreate(path.c_str(), H5F_ACC_EXCL, H5P_DEFAULT, properties);
}

}  // namespace

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

Hdf5File::Hdf5File(const std::string& path, Hdf5Access access) : path_(path)
{
    silence_hdf5();
    const hid_t file = open_file(path, access);
    if (file < 0) {
        const int error = commit_open_error();
        const bool present = std::filesystem::exists(path);
        if (access == Hdf5Access::create || (present && error != 0)) throw WriteError(path, error);
        throw InputError({path, 0, 0, {}}, present ? hdf5_error() : "no file", "an HDF5 file");
    }
    file_ = Hdf5Id(file, H5Fclose, path);
}

void Hdf5File::flush()
{
    require_hdf5(H5Fflush(file_, H5F_SCOPE_LOCAL), "flush " + path_);
    if (const int error = commit_error(file_); error != 0) throw WriteError(path_, error);
}

void Hdf5File::close()
{
    flush();
    file_.reset();
}

void Hdf5File::make_group(const std::string& group)
{
    Hdf5Id(H5Gcreate2(file_, group.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose, group);
}

void Hdf5File::link(const std::string& target, const std::string& name)
{
    require_hdf5(H5Lcreate_hard(file_, target.c_str(), file_, name.c_str(), H5P_DEFAULT, H5P_DEFAULT), name);
}

void Hdf5File::link_softly(const std::string& target, const std::string& name)
{
    require_hdf5(H5Lcreate_soft(target.c_str(), file_, name.c_str(), H5P_DEFAULT, H5P_DEFAULT), name);
}

Hdf5Id Hdf5File::make_dataset(const std::string& name, hid_t file_type, const std::vector<hsize_t>& shape,
                              const Hdf5Storage& storage)
{
    const Hdf5Id space = simple_space(shape, storage.growing);
    const Hdf5Id properties(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, name);
    // An empty dataset is left contiguous: a chunk cannot have the shape of no data, and there is nothing to compress.
    const bool empty = std::ranges::count(shape, hsize_t(0)) > 0;
    const std::vector<hsize_t>& chunk = storage.compressed && storage.chunk.empty() && !empty ? shape : storage.chunk;
    if (!chunk.empty()) {
        require_hdf5(H5Pset_chunk(properties, int(chunk.size()), chunk.data()), name);
        if (storage.compressed) require_hdf5(H5Pset_shuffle(properties), name);
        if (storage.compressed) require_hdf5(H5Pset_deflate(properties, 1), name);
    }
    return {H5Dcreate2(file_, name.c_str(), file_type, space, H5P_DEFAULT, properties, H5P_DEFAULT), H5Dclose, name};
}

Hdf5Id Hdf5File::open_dataset(const std::string& name) const
{
    return {H5Dopen2(file_, name.c_str(), H5P_DEFAULT), H5Dclose, name};
}

void Hdf5File::write(const std::string& name, hid_t file_type, const std::vector<hsize_t>& shape,
                     std::span<const double> values, const Hdf5Storage& storage)
{
    const Hdf5Id dataset = make_dataset(name, file_type, shape, storage);
    if (values.empty()) return;
    require_hdf5(H5Dwrite(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), name);
}

void Hdf5File::write(const std::string& name, hid_t file_type, const std::vector<hsize_t>& shape,
                     std::span<const std::int64_t> values, const Hdf5Storage& storage)
{
    const Hdf5Id dataset = make_dataset(name, file_type, shape, storage);
    if (values.empty()) return;
    require_hdf5(H5Dwrite(dataset, H5T_NATIVE_INT64, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), name);
}

Hdf5Id Hdf5File::open_object(const std::string& object) const
{
    return {H5Oopen(file_, object.c_str(), H5P_DEFAULT), H5Oclose, object};
}

Hdf5Id Hdf5File::make_attribute(const std::string& object, const char* name, hid_t type, hid_t space)
{
    return {H5Acreate2(open_object(object), name, type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose, name};
}

void Hdf5File::set_integers(const std::string& object, const char* name, std::span<const std::int64_t> values)
{
    const Hdf5Id space = simple_space({values.size()});
    require_hdf5(H5Awrite(make_attribute(object, name, H5T_STD_I64LE, space), H5T_NATIVE_INT64, values.data()), name);
}

void Hdf5File::set_integer(const std::string& object, const char* name, std::int64_t value)
{
    if (H5Aexists_by_name(file_, object.c_str(), name, H5P_DEFAULT) > 0) {
        const Hdf5Id attribute(H5Aopen(open_object(object), name, H5P_DEFAULT), H5Aclose, name);
        require_hdf5(H5Awrite(attribute, H5T_NATIVE_INT64, &value), name);
        return;
    }
    const Hdf5Id space(H5Screate(H5S_SCALAR), H5Sclose, name);
    require_hdf5(H5Awrite(make_attribute(object, name, H5T_STD_I64LE, space), H5T_NATIVE_INT64, &value), name);
}

void Hdf5File::set_real(const std::string& object, const char* name, double value)
{
    const Hdf5Id space(H5Screate(H5S_SCALAR), H5Sclose, name);
    require_hdf5(H5Awrite(make_attribute(object, name, H5T_IEEE_F64LE, space), H5T_NATIVE_DOUBLE, &value), name);
}

void Hdf5File::set_text(const std::string& object, const char* name, const std::string& text)
{
    const Hdf5Id type = text_type();
    const Hdf5Id space(H5Screate(H5S_SCALAR), H5Sclose, name);
    const char* value = text.c_str();
    require_hdf5(H5Awrite(make_attribute(object, name, type, space), type, &value), name);
}

void Hdf5File::set_fixed_text(const std::string& object, const char* name, const std::string& text)
{
    const Hdf5Id type(H5Tcopy(H5T_C_S1), H5Tclose, name);
    require_hdf5(H5Tset_size(type, std::max<std::size_t>(1, text.size())), name);
    require_hdf5(H5Tset_strpad(type, H5T_STR_NULLPAD), name);
    const Hdf5Id space(H5Screate(H5S_SCALAR), H5Sclose, name);
    require_hdf5(H5Awrite(make_attribute(object, name, type, space), type, text.c_str()), name);
}

void Hdf5File::set_texts(const std::string& object, const char* name, const std::vector<std::string>& texts)
{
    const Hdf5Id type = text_type();
    const Hdf5Id space = simple_space({texts.size()});
    std::vector<const char*> values;
    for (const std::string& text : texts) values.push_back(text.c_str());
    if (texts.size() <= most_attribute_texts) {
        require_hdf5(H5Awrite(make_attribute(object, name, type, space), type, values.data()), name);
        return;
    }
    const Hdf5Id dataset(
        H5Dcreate2(file_, (object + "/" + name).c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Dclose,
        name);
    require_hdf5(H5Dwrite(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), name);
}

}  // namespace selvage
