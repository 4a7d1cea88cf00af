#include "io/steady_read.hpp"

#include <chrono>
#include <thread>

#include <sys/stat.h>

namespace selvage {

FileWatch::FileWatch(const std::string& path) : path_(path), last_(look()) {}

FileWatch::Look FileWatch::look() const
{
    struct stat status {};
    if (::stat(path_.c_str(), &status) != 0) return {};
    return {status.st_mtim.tv_sec, status.st_mtim.tv_nsec, status.st_size};
}

bool FileWatch::has_changed()
{
    // Times of change are as coarse as some milliseconds.
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    const Look now = look();
    const bool changed = now != last_;
    last_ = now;
    return changed && ++changes_ <= 10;
}

}  // namespace selvage
