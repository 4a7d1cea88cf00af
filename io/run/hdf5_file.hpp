#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "io/run/hdf5_id.hpp"

namespace selvage {

/// How a dataset is stored; an empty `chunk` means contiguous, or one chunk if compressed.
struct Hdf5Storage {
    bool compressed = false;  ///< By the shuffle filter and gzip level 1.
    bool growing = false;     ///< The first dimension is unlimited.
    std::vector<hsize_t> chunk;
    bool checked = false;  ///< With a checksum per chunk, so that damage is detected when reading.
};

enum class Hdf5Access { create, read, append };

/// A file with typed access by path. Shapes are row-major; reading converts number types.
///
/// What is read is not trusted: every reading function throws InputError, naming the object, if the object is missing
/// or damaged, has another shape or number type than asked for, lies outside the file (an external link, a virtual
/// dataset, external storage), or would take more memory than the file accounts for; see check_dataset.
class Hdf5File {
public:
    /// Stands for an extent that may have any value.
    static constexpr hsize_t any = H5S_UNLIMITED;

    /// `create` makes a new file; `append` opens one for writing. Both write through the commit driver, and to no file
    /// that is behind a symbolic link.
    /// @throws InputError if the file cannot be opened, is not HDF5 or not a regular file; WriteError if `create` finds
    /// a file or cannot make one
    Hdf5File(const std::string& path, Hdf5Access access);

    const std::string& path() const { return path_; }
    hid_t id() const { return file_; }
    bool exists(const std::string& object) const;  ///< True if every link of the path exists and leads to an object.
    std::uintmax_t size() const;                   ///< Length of the file on disk [bytes].
    /// Brings all that has been written into the file.
    /// @throws WriteError if something since the file was opened could not be written, as on a full disk
    void flush();
    void close();  ///< Flushes, then closes; the destructor closes without a word on what could not be written.

    void make_group(const std::string& group);
    void link(const std::string& target, const std::string& name);  ///< Gives an object a second name.
    void link_softly(const std::string& target, const std::string& name);

    /// @param file_type  number type in the file
    Hdf5Id make_dataset(const std::string& name, hid_t file_type, const std::vector<hsize_t>& shape,
                        const Hdf5Storage& storage = {});
    Hdf5Id open_dataset(const std::string& name) const;
    void write(const std::string& name, hid_t file_type, const std::vector<hsize_t>& shape,
               std::span<const double> values, const Hdf5Storage& storage = {});
    void write(const std::string& name, hid_t file_type, const std::vector<hsize_t>& shape,
               std::span<const std::int64_t> values, const Hdf5Storage& storage = {});

    std::vector<hsize_t> shape(const std::string& name) const;
    /// @param shape  that the dataset must have, see `any`; empty: every shape will do
    /// @param rows   if not `any`: only so many of its first rows are read; it may have more
    std::vector<double> read_reals(const std::string& name, const std::vector<hsize_t>& shape = {},
                                   hsize_t rows = any) const;
    std::vector<std::int64_t> read_integers(const std::string& name, const std::vector<hsize_t>& shape = {},
                                            hsize_t rows = any) const;
    /// Reads integers, each of which must be in [0, count).
    /// @param what  what they are indices of, as in `point`
    std::vector<int> read_indices(const std::string& name, const std::vector<hsize_t>& shape, std::int64_t count,
                                  const char* what) const;
    /// Names of a group's members, sorted.
    std::vector<std::string> members(const std::string& group) const;

    // Attributes; a text is UTF-8 of variable length unless said otherwise.
    void set_integers(const std::string& object, const char* name, std::span<const std::int64_t> values);
    void set_integer(const std::string& object, const char* name, std::int64_t value);  ///< Scalar; overwrites.
    void set_real(const std::string& object, const char* name, double value);
    void set_text(const std::string& object, const char* name, const std::string& text);
    void set_fixed_text(const std::string& object, const char* name, const std::string& text);  ///< ASCII.
    /// More than an attribute can hold become a dataset of that name within the object.
    void set_texts(const std::string& object, const char* name, const std::vector<std::string>& texts);
    std::int64_t integer(const std::string& object, const char* name) const;  ///< A single one.
    double real(const std::string& object, const char* name) const;
    std::string text(const std::string& object, const char* name) const;
    std::vector<std::string> texts(const std::string& object, const char* name) const;  ///< Empty if absent.

    [[noreturn]] void refuse(const std::string& object, std::string_view found, std::string_view expected) const;

private:
    template <class Number>
    std::vector<Number> read(const std::string& name, hid_t type, const std::vector<hsize_t>& shape,
                             hsize_t rows) const;
    void require_links(const std::string& object) const;
    void require_read(herr_t status, const std::string& object) const;
    void require_single(hid_t attribute, const std::string& name, H5T_class_t number_class) const;
    Hdf5Id opened(hid_t id, Hdf5Id::Closer closer, const std::string& object) const;
    Hdf5Id open_object(const std::string& object) const;
    Hdf5Id open_attribute(const std::string& object, const char* name) const;
    Hdf5Id make_attribute(const std::string& object, const char* name, hid_t type, hid_t space);

    std::string path_;
    Hdf5Id file_;
    mutable std::uintmax_t bytes_read_ = 0;  ///< Of all arrays so far.
};

}  // namespace selvage
