#include "io/run/hdf5_file.hpp"

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <stdexcept>

#include "io/atomic_file.hpp"
#include "io/run/commit_driver.hpp"
#include "io/run/hdf5_checks.hpp"

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

std::vector<hsize_t> shape_of(hid_t space)
{
    const int rank = H5Sget_simple_extent_ndims(space);
    if (rank < 0) return {0};
    std::vector<hsize_t> extent(static_cast<std::size_t>(rank));
    H5Sget_simple_extent_dims(space, extent.data(), nullptr);
    return extent;
}

bool fits(const std::vector<hsize_t>& extent, const std::vector<hsize_t>& asked)
{
    return std::ranges::equal(extent, asked, [](hsize_t a, hsize_t b) { return a == b || b == Hdf5File::any; });
}

std::string shape_text(const std::vector<hsize_t>& shape)
{
    std::string text;
    for (const hsize_t extent : shape)
        text += (text.empty() ? "(" : ", ") + (extent == Hdf5File::any ? "any" : std::to_string(extent));
    return text.empty() ? "()" : text + ")";
}

// The product of the extents, or the largest number where it is too large for one.
hsize_t number_count(const std::vector<hsize_t>& shape)
{
    hsize_t count = 1;
    for (const hsize_t extent : shape) count = saturated_product(count, extent);
    return count;
}

hid_t open_file(const std::string& path, Hdf5Access access)
{
    const Hdf5Id properties(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, "file access properties");
    if (access == Hdf5Access::read) {
        use_commit_driver(properties);  // takes no lock and opens nothing but files
        return H5Fopen(path.c_str(), H5F_ACC_RDONLY, properties);
    }
    // HDF5's default up to 1.14. Headers in the newer formats have checksums, which the order of writes breaks.
    require_hdf5(H5Pset_libver_bounds(properties, H5F_LIBVER_EARLIEST, H5F_LIBVER_LATEST), "versions of the format");
    use_commit_driver(properties);
    if (access == Hdf5Access::append) return H5Fopen(path.c_str(), H5F_ACC_RDWR, properties);
    return H5Fcreate(path.c_str(), H5F_ACC_EXCL, H5P_DEFAULT, properties);
}

}  // namespace

Hdf5File::Hdf5File(const std::string& path, Hdf5Access access) : path_(path)
{
    silence_hdf5();
    confine_hdf5();
    std::error_code error;
    const InputPlace place{path, 0, 0, {}};
    const bool present = std::filesystem::exists(path, error);
    if (present && !std::filesystem::is_regular_file(path, error))
        throw InputError(place, "something that is not a file", "an HDF5 file");
    const hid_t file = open_file(path, access);
    if (file < 0) {
        const int error = commit_open_error();
        if (access == Hdf5Access::create || (access == Hdf5Access::append && present && error != 0))
            throw WriteError(path, error);
        if (present && error != 0) throw InputError(place, std::strerror(error), "an HDF5 file that can be read");
        throw InputError(place, present ? hdf5_error() : "no file", "an HDF5 file");
    }
    file_ = Hdf5Id(file, H5Fclose, path);
}

std::uintmax_t Hdf5File::size() const
{
    hsize_t bytes = 0;
    require_read(H5Fget_filesize(file_, &bytes), "/");
    return bytes;
}

void Hdf5File::refuse(const std::string& object, std::string_view found, std::string_view expected) const
{
    throw InputError({path_, 0, 0, object}, found, expected);
}

void Hdf5File::require_read(herr_t status, const std::string& object) const
{
    if (status < 0) refuse(object, "damaged data (HDF5: " + hdf5_error() + ")", "what selvage writes there");
}

Hdf5Id Hdf5File::opened(hid_t id, Hdf5Id::Closer closer, const std::string& object) const
{
    require_read(id < 0 ? -1 : 0, object);
    return {id, closer, object};
}

void Hdf5File::require_links(const std::string& object) const
{
    for (std::size_t slash = object.find('/', 1);; slash = object.find('/', slash + 1)) {
        if (object == "/") return;
        const std::string part = object.substr(0, slash);
        if (const Hdf5Fault fault = check_link(file_, part)) refuse(part, fault.found, fault.expected);
        if (slash == std::string::npos) return;
    }
}

bool Hdf5File::exists(const std::string& object) const
{
    require_links(object);
    for (std::size_t slash = object.find('/', 1);; slash = object.find('/', slash + 1)) {
        if (H5Oexists_by_name(file_, object.substr(0, slash).c_str(), H5P_DEFAULT) <= 0) return false;
        if (slash == std::string::npos) return true;
    }
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
        if (storage.checked) require_hdf5(H5Pset_fletcher32(properties), name);
    }
    return {H5Dcreate2(file_, name.c_str(), file_type, space, H5P_DEFAULT, properties, H5P_DEFAULT), H5Dclose, name};
}

Hdf5Id Hdf5File::open_dataset(const std::string& name) const
{
    require_links(name);
    Hdf5Id dataset = opened(H5Dopen2(file_, name.c_str(), H5P_DEFAULT), H5Dclose, name);
    if (const Hdf5Fault fault = check_data_place(dataset)) refuse(name, fault.found, fault.expected);
    return dataset;
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

std::vector<hsize_t> Hdf5File::shape(const std::string& name) const
{
    const Hdf5Id dataset = open_dataset(name);
    return shape_of(opened(H5Dget_space(dataset), H5Sclose, name));
}

template <class Number>
std::vector<Number> Hdf5File::read(const std::string& name, hid_t type, const std::vector<hsize_t>& shape,
                                   hsize_t rows) const
{
    const Hdf5Id dataset = open_dataset(name);
    const Hdf5Id space = opened(H5Dget_space(dataset), H5Sclose, name);
    const Hdf5Id file_type = opened(H5Dget_type(dataset), H5Tclose, name);
    if (std::is_integral_v<Number> && H5Tget_class(file_type) != H5T_INTEGER) refuse(name, "no integers", "integers");
    std::vector<hsize_t> extent = shape_of(space);
    const bool short_of_rows = rows != any && (extent.empty() || extent[0] < rows);
    if ((!shape.empty() && !fits(extent, shape)) || short_of_rows)
        refuse(name, "shape " + shape_text(extent),
               "shape " + shape_text(shape) + (short_of_rows ? ", at least " + std::to_string(rows) + " rows" : ""));
    if (rows != any) extent[0] = rows;
    const hsize_t count = number_count(extent);
    const std::uintmax_t bytes = saturated_product(count, H5Tget_size(file_type));
    const std::uintmax_t most = saturated_product(most_file_expansion, size());
    if (const Hdf5Fault fault = check_dataset(dataset, bytes, size(), most - bytes_read_))
        refuse(name, fault.found, fault.expected);
    bytes_read_ += bytes;
    std::vector<Number> values(count);
    if (count == 0) return values;
    const std::vector<hsize_t> start(extent.size(), 0);
    if (!extent.empty())
        require_read(H5Sselect_hyperslab(space, H5S_SELECT_SET, start.data(), nullptr, extent.data(), nullptr), name);
    const Hdf5Id target = simple_space({count});
    require_read(H5Dread(dataset, type, target, space, H5P_DEFAULT, values.data()), name);
    return values;
}

std::vector<double> Hdf5File::read_reals(const std::string& name, const std::vector<hsize_t>& shape, hsize_t rows) const
{
    return read<double>(name, H5T_NATIVE_DOUBLE, shape, rows);
}

std::vector<std::int64_t> Hdf5File::read_integers(const std::string& name, const std::vector<hsize_t>& shape,
                                                  hsize_t rows) const
{
    return read<std::int64_t>(name, H5T_NATIVE_INT64, shape, rows);
}

std::vector<int> Hdf5File::read_indices(const std::string& name, const std::vector<hsize_t>& shape, std::int64_t count,
                                        const char* what) const
{
    const std::vector<std::int64_t> values = read_integers(name, shape);
    const auto wrong = std::ranges::find_if(values, [&](std::int64_t value) { return value < 0 || value >= count; });
    if (wrong != values.end()) {
        const std::size_t width = shape.size() > 1 ? shape.back() : 1,
                          row = std::size_t(wrong - values.begin()) / width;
        refuse(name + "[" + std::to_string(row) + "]", what + (" " + std::to_string(*wrong)),
               "one of the " + std::to_string(count) + " from 0 to " + std::to_string(count - 1));
    }
    return {values.begin(), values.end()};
}

std::vector<std::string> Hdf5File::members(const std::string& group) const
{
    require_links(group);
    const Hdf5Id id = opened(H5Gopen2(file_, group.c_str(), H5P_DEFAULT), H5Gclose, group);
    std::vector<std::string> names;
    const H5L_iterate_t collect = [](hid_t, const char* name, const H5L_info_t*, void* target) -> herr_t {
        static_cast<std::vector<std::string>*>(target)->emplace_back(name);
        return 0;
    };
    require_read(H5Literate(id, H5_INDEX_NAME, H5_ITER_INC, nullptr, collect, &names), group);
    return names;
}

Hdf5Id Hdf5File::open_object(const std::string& object) const
{
    require_links(object);
    return opened(H5Oopen(file_, object.c_str(), H5P_DEFAULT), H5Oclose, object);
}

Hdf5Id Hdf5File::open_attribute(const std::string& object, const char* name) const
{
    return opened(H5Aopen(open_object(object), name, H5P_DEFAULT), H5Aclose, object + "@" + name);
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
        require_hdf5(H5Awrite(open_attribute(object, name), H5T_NATIVE_INT64, &value), name);
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

std::int64_t Hdf5File::integer(const std::string& object, const char* name) const
{
    const Hdf5Id attribute = open_attribute(object, name);
    require_single(attribute, object + "@" + name, H5T_INTEGER);
    std::int64_t value = 0;
    require_read(H5Aread(attribute, H5T_NATIVE_INT64, &value), object + "@" + name);
    return value;
}

double Hdf5File::real(const std::string& object, const char* name) const
{
    const Hdf5Id attribute = open_attribute(object, name);
    require_single(attribute, object + "@" + name, H5T_FLOAT);
    double value = 0;
    require_read(H5Aread(attribute, H5T_NATIVE_DOUBLE, &value), object + "@" + name);
    return value;
}

void Hdf5File::require_single(hid_t attribute, const std::string& name, H5T_class_t number_class) const
{
    const Hdf5Id space = opened(H5Aget_space(attribute), H5Sclose, name);
    const Hdf5Id type = opened(H5Aget_type(attribute), H5Tclose, name);
    if (H5Sget_simple_extent_npoints(space) != 1)
        refuse(name, "shape " + shape_text(shape_of(space)), "a single number");
    if (H5Tget_class(type) != number_class || H5Tget_size(type) > sizeof(double))
        refuse(name, "another type of data", number_class == H5T_INTEGER ? "a whole number" : "a real number");
}

std::string Hdf5File::text(const std::string& object, const char* name) const
{
    const std::vector<std::string> all = texts(object, name);
    if (all.size() != 1) refuse(object + "@" + name, std::to_string(all.size()) + " texts", "one text");
    return all.front();
}

std::vector<std::string> Hdf5File::texts(const std::string& object, const char* name) const
{
    require_links(object);
    const bool is_attribute = H5Aexists_by_name(file_, object.c_str(), name, H5P_DEFAULT) > 0;
    const std::string place = object + (is_attribute ? "@" : "/") + name;
    if (!is_attribute && !exists(place)) return {};
    const Hdf5Id holder = is_attribute ? open_attribute(object, name) : open_dataset(place);
    const Hdf5Id space = opened(is_attribute ? H5Aget_space(holder) : H5Dget_space(holder), H5Sclose, place);
    const Hdf5Id file_type = opened(is_attribute ? H5Aget_type(holder) : H5Dget_type(holder), H5Tclose, place);
    if (H5Tis_variable_str(file_type) <= 0) refuse(place, "another type of data", "text of variable length");
    const Hdf5Id type = text_type();
    const hssize_t count = H5Sget_simple_extent_npoints(space);
    if (count < 0 || std::uintmax_t(count) > size()) refuse(place, "too many texts", "no more than the file can hold");
    std::vector<char*> values(static_cast<std::size_t>(count));
    require_read(is_attribute ? H5Aread(holder, type, values.data())
                              : H5Dread(holder, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()),
                 place);
    std::vector<std::string> result;
    for (const char* value : values) result.emplace_back(value ? value : "");
    require_read(H5Dvlen_reclaim(type, space, H5P_DEFAULT, values.data()), place);
    return result;
}

}  // namespace selvage
