#pragma once
#include <cstdint>
#include <string>

#include "io/errors.hpp"

namespace selvage {

/// Tells whether a file has changed since this was made.
class FileWatch {
public:
    explicit FileWatch(const std::string& path);

    /// Waits a moment and looks. True at most ten times, for a file that never rests.
    bool has_changed();

private:
    struct Look {
        std::int64_t seconds = 0, nanoseconds = 0, size = 0;
        bool operator==(const Look&) const = default;
    };
    Look look() const;

    std::string path_;
    Look last_;
    int changes_ = 0;
};

/// Reads a file to which a run may be writing. Each of its states can be read, but not a mixture of two: where reading
/// fails and the file has changed meanwhile, it is read again.
template <class Read>
auto read_steadily(const std::string& path, const Read& read)
{
    FileWatch watch(path);
    while (true) {
        try {
            return read();
        } catch (const InputError&) {
            if (!watch.has_changed()) throw;
        }
    }
}

}  // namespace selvage
