#pragma once
#include <string>
#include <string_view>

#include "io/errors.hpp"

namespace selvage {

/// A file that cannot be written, as on a full disk: exit code 2. The message says what would cure it.
class WriteError : public InputError {
public:
    /// @param path   of the file or of its temporary file
    /// @param error  as in errno; 0 if unknown
    WriteError(const std::string& path, int error);

    int error() const { return error_; }  ///< As in errno.

    /// Adds to the message what has become of the run.
    void add(const std::string& text) { text_ += text; }
    const char* what() const noexcept override { return text_.c_str(); }

private:
    int error_;
    std::string text_;
};

/// Returns a name that nobody can foresee for a file that is to be renamed to `path`, in the same folder:
/// path.RANDOM.partial. Files are made under it only if there is none, so that they never go through a link.
std::string temporary_name(const std::string& path);

/// Returns whether a file name is one of those that temporary_name gives for `name`, or that earlier versions gave.
bool is_temporary_name_of(const std::string& name, std::string_view candidate);

/// The temporary file of a path; removed unless it has been moved into place.
class TemporaryFile {
public:
    explicit TemporaryFile(const std::string& path) : path_(path), name_(temporary_name(path)) {}
    TemporaryFile(const TemporaryFile&) = delete;
    TemporaryFile& operator=(const TemporaryFile&) = delete;
    ~TemporaryFile();

    const std::string& name() const { return name_; }

    /// Synchronises the finished file to the disk and renames it to its path, so that readers see either the old or
    /// the new file.
    /// @throws WriteError if that fails
    void move_into_place();

private:
    std::string path_, name_;
    bool moved_ = false;
};

/// Writes a whole file under a temporary name and moves it into place.
/// @throws WriteError if that fails
void write_file_atomically(const std::string& path, std::string_view bytes);

/// Returns the file name of a path without its folder.
std::string file_name(const std::string& path);

}  // namespace selvage
