#include "io/atomic_file.hpp"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <random>

#include <fcntl.h>
#include <unistd.h>

namespace selvage {
namespace {

constexpr std::string_view ending = ".partial";
constexpr std::size_t digits = 12;  // of 5 bits each, which nobody finds by trying

// The file that the user knows: the one that a temporary file was to become.
std::string known_name(const std::string& path)
{
    const std::size_t more = 1 + digits + ending.size();
    const bool temporary = path.ends_with(ending) && path.size() > more && path[path.size() - more] == '.';
    return temporary ? path.substr(0, path.size() - more) : path;
}

std::string_view cure(int error)
{
    switch (error) {
        case ENOSPC:
            return "room on its disk: free some, or choose a folder on another one (-o)";
        case EDQUOT:
            return "room within the quota of its disk: free some, or choose a folder on another one (-o)";
        case EFBIG:
            return "a larger limit for the size of a file (ulimit -f)";
        case ENOENT:
        case ENOTDIR:
        case ESTALE:
            return "its folder, which is gone";
        case ELOOP:
            return "a file or nothing, but no symbolic link";
        default:
            return "a place that can be written";
    }
}

bool synchronise(const std::string& path, int flags)
{
    const int descriptor = ::open(path.c_str(), flags | O_CLOEXEC);
    if (descriptor < 0) return false;
    const bool done = ::fsync(descriptor) == 0;
    const int error = errno;
    ::close(descriptor);
    errno = error;
    return done;
}

// Returns errno.
int write_new_file(const std::string& path, std::string_view bytes)
{
    const int descriptor = ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666);
    if (descriptor < 0) return errno;
    int error = 0;
    while (!bytes.empty() && error == 0) {
        const ssize_t count = ::write(descriptor, bytes.data(), bytes.size());
        if (count < 0)
            error = errno == EINTR ? 0 : errno;
        else
            bytes.remove_prefix(std::size_t(count));
    }
    // Some file systems tell only now that there is no room.
    if (::close(descriptor) != 0 && error == 0) error = errno;
    return error;
}

}  // namespace

WriteError::WriteError(const std::string& path, int error)
    : InputError({known_name(path), 0, 0, {}}, error == 0 ? "an unknown fault" : std::strerror(error), cure(error)),
      error_(error), text_(InputError::what())
{
}

std::string temporary_name(const std::string& path)
{
    static std::random_device device;
    std::string name = path + ".";
    for (std::size_t digit = 0; digit < digits; ++digit) name += "0123456789abcdefghijklmnopqrstuv"[device() % 32];
    return name.append(ending);
}

bool is_temporary_name_of(const std::string& name, std::string_view candidate)
{
    return candidate.starts_with(name + ".") && candidate.ends_with(ending);
}

TemporaryFile::~TemporaryFile()
{
    if (!moved_) ::unlink(name_.c_str());
}

void TemporaryFile::move_into_place()
{
    if (!synchronise(name_, O_RDWR | O_NOFOLLOW)) throw WriteError(path_, errno);
    if (std::rename(name_.c_str(), path_.c_str()) != 0) throw WriteError(path_, errno);
    moved_ = true;
    // A failure is ignored, because some file systems cannot synchronise a folder; the rename is atomic nevertheless.
    const std::filesystem::path folder = std::filesystem::path(path_).parent_path();
    synchronise(folder.empty() ? "." : folder.string(), O_RDONLY | O_DIRECTORY);
}

void write_file_atomically(const std::string& path, std::string_view bytes)
{
    TemporaryFile temporary(path);
    if (const int error = write_new_file(temporary.name(), bytes); error != 0) throw WriteError(path, error);
    temporary.move_into_place();
}

std::string file_name(const std::string& path) { return std::filesystem::path(path).filename().string(); }

}  // namespace selvage
