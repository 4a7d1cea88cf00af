#include "io/atomic_file.hpp"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>

#include <fcntl.h>
#include <unistd.h>

#include "io/errors.hpp"

namespace selvage {
namespace {

[[noreturn]] void fail(const std::string& path)
{
    throw InputError({path, 0, 0, {}}, std::strerror(errno), "a place that can be written");
}

bool synchronise(const std::string& path, int flags)
{
    const int descriptor = ::open(path.c_str(), flags | O_CLOEXEC);
    if (descriptor < 0) return false;
    const bool done = ::fsync(descriptor) == 0;
    ::close(descriptor);
    return done;
}

}  // namespace

std::string temporary_name(const std::string& path) { return path + ".partial"; }

void move_into_place(const std::string& temporary, const std::string& path)
{
    if (!synchronise(temporary, O_RDWR)) fail(temporary);
    if (std::rename(temporary.c_str(), path.c_str()) != 0) fail(path);
    // A failure is ignored, because some file systems cannot synchronise a folder; the rename is atomic nevertheless.
    const std::filesystem::path folder = std::filesystem::path(path).parent_path();
    synchronise(folder.empty() ? "." : folder.string(), O_RDONLY | O_DIRECTORY);
}

void write_file_atomically(const std::string& path, std::string_view text)
{
    const std::string temporary = temporary_name(path);
    std::FILE* file = std::fopen(temporary.c_str(), "wbe");
    if (!file) fail(temporary);
    const bool written = std::fwrite(text.data(), 1, text.size(), file) == text.size();
    if (std::fclose(file) != 0 || !written) fail(temporary);
    move_into_place(temporary, path);
}

std::string file_name(const std::string& path) { return std::filesystem::path(path).filename().string(); }

}  // namespace selvage
