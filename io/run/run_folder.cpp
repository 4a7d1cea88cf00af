#include "io/run/run_folder.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "io/utf8.hpp"

namespace selvage {
namespace {

constexpr const char* lock_name = "run.lock";

bool is_same(const struct stat& a, const struct stat& b) { return a.st_dev == b.st_dev && a.st_ino == b.st_ino; }

bool leads_to(const std::string& path, int descriptor)
{
    struct stat named {
    }, held{};
    return ::stat(path.c_str(), &named) == 0 && ::fstat(descriptor, &held) == 0 && is_same(named, held);
}

std::string own_name()
{
    std::array<char, 256> host{};
    if (::gethostname(host.data(), host.size() - 1) != 0) host[0] = 0;
    return "process " + std::to_string(::getpid()) + (host[0] ? " on " + std::string(host.data()) : "");
}

// Others may have written into the file.
std::string name_in(int descriptor)
{
    std::array<char, 200> text{};
    const ssize_t count = ::pread(descriptor, text.data(), text.size(), 0);
    return printable({text.data(), std::size_t(std::max<ssize_t>(count, 0))});
}

}  // namespace

RunFolder::RunFolder(const std::string& path) : path_(path)
{
    std::error_code error;
    made_ = std::filesystem::create_directories(path, error);
    if (error) throw InputError({path, 0, 0, {}}, error.message(), "a folder that can be made or written");
    folder_ = ::open(path.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (folder_ < 0) throw WriteError(path, errno);
    try {
        lock();
    } catch (...) {
        release();
        throw;
    }
}

RunFolder::~RunFolder() { release(); }

void RunFolder::release()
{
    // Removed while it is locked: whoever opened it before that finds another file or none under its name.
    if (lock_ >= 0) {
        ::unlinkat(folder_, lock_name, 0);
        ::close(lock_);
    }
    if (made_ && leads_to(path_, folder_)) ::rmdir(path_.c_str());
    ::close(folder_);
}

void RunFolder::lock()
{
    const std::string path = path_ + "/" + lock_name;
    const InputPlace place{path, 0, 0, {}};
    while (true) {
        const int flags = O_RDWR | O_CREAT | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC;
        const int descriptor = ::openat(folder_, lock_name, flags, 0666);
        if (descriptor < 0) throw WriteError(path, errno);
        struct stat opened {
        }, named{};
        if (::fstat(descriptor, &opened) != 0 || !S_ISREG(opened.st_mode)) {
            ::close(descriptor);
            throw InputError(place, "something that is not a file", "a file or nothing");
        }
        const int fault = ::flock(descriptor, LOCK_EX | LOCK_NB) == 0 ? 0 : errno;
        const std::string name = name_in(descriptor);
        if (fault == EWOULDBLOCK) {
            ::close(descriptor);
            throw InputError({path_, 0, 0, {}}, "the results of " + (name.empty() ? "another process" : name),
                             "a folder that no other run writes to: wait for its end, or choose another one (-o)");
        }
        if (fault != 0)
            not_locked_ = path + " cannot be locked (" + std::strerror(fault) + "): see that no other run writes to " +
                          path_ + (name.empty() ? "" : ", as " + name + " does or did");
        const bool stays = ::fstatat(folder_, lock_name, &named, AT_SYMLINK_NOFOLLOW) == 0 && is_same(opened, named);
        if (stays) {
            lock_ = descriptor;
            break;
        }
        ::close(descriptor);  // a run that ended meanwhile has removed it
    }
    // Without a name, as on a full disk, the lock holds as well.
    const std::string name = own_name();
    if (::ftruncate(lock_, 0) != 0 || ::pwrite(lock_, name.data(), name.size(), 0) < 0) return;
}

const std::string& RunFolder::path()
{
    if (leads_to(path_, folder_)) return path_;
    std::error_code error;
    const std::string now = std::filesystem::read_symlink("/proc/self/fd/" + std::to_string(folder_), error).string();
    if (error || !leads_to(now, folder_)) throw WriteError(path_, ENOENT);
    return path_ = now;
}

void RunFolder::remove(const std::string& name)
{
    if (::unlinkat(folder_, name.c_str(), 0) == 0 || errno == ENOENT) return;
    const std::string path = path_ + "/" + name;
    if (errno == EISDIR) throw InputError({path, 0, 0, {}}, "a folder", "a file of an earlier run, or nothing");
    throw WriteError(path, errno);
}

void RunFolder::remove_temporary_files(std::span<const std::string> names)
{
    std::error_code error;
    for (const auto& entry : std::filesystem::directory_iterator(path(), error)) {
        const std::string found = entry.path().filename().string();
        const auto is_of = [&](const std::string& name) { return is_temporary_name_of(name, found); };
        if (std::ranges::any_of(names, is_of)) ::unlinkat(folder_, found.c_str(), 0);
    }
}

}  // namespace selvage
