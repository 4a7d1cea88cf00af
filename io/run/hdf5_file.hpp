#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

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

/// How a dataset is stored; an empty `chunk` means contiguous, or one chunk if compressed.
struct Hdf5Storage {
    bool compressed = false;  ///< By the shuffle filter and gzip level 1.
    bool growing = false;     ///< The first dimension is unlimited.
    std::vector<hsize_t> chunk;
};

enum class Hdf5Access { create, append };

/// A file that is written, with typed access by path. Shapes are row-major. To read one, see Hdf5Reader.
class Hdf5File {
public:
    /// `create` makes a new file; `append` opens one that this program has made. Both write through the commit driver,
    /// and to no file that is behind a symbolic link.
    /// @throws InputError if the file cannot be opened or is not HDF5; WriteError if `create` finds a file or cannot
    /// make one
    Hdf5File(const std::string& path, Hdf5Access access);

    hid_t id() const { return file_; }
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

    // Attributes; a text is UTF-8 of variable length unless said otherwise.
    void set_integers(const std::string& object, const char* name, std::span<const std::int64_t> values);
    void set_integer(const std::string& object, const char* name, std::int64_t value);  ///< Scalar; overwrites.
    void set_real(const std::string& object, const char* name, double value);
    void set_text(const std::string& object, const char* name, const std::string& text);
    void set_fixed_text(const std::string& object, const char* name, const std::string& text);  ///< ASCII.
    /// More than an attribute can hold become a dataset of that name within the object.
    void set_texts(const std::string& object, const char* name, const std::vector<std::string>& texts);

private:
    Hdf5Id open_object(const std::string& object) const;
    Hdf5Id make_attribute(const std::string& object, const char* name, hid_t type, hid_t space);

    std::string path_;
    Hdf5Id file_;
};

}  // namespace selvage
