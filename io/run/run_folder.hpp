#pragma once
#include <span>
#include <string>

#include "io/atomic_file.hpp"

namespace selvage {

/// The folder of a run's results, held by one run at a time.
///
/// The hold is a lock of the system (flock) on the file run.lock in it, which ends with the process, however that ends;
/// the file itself holds the name of the run for whom it refuses and may stay behind. Readers of the results take no
/// lock.
class RunFolder {
public:
    /// Makes the folder if it is missing, and takes hold of it.
    /// @throws InputError if another run holds it; WriteError if it cannot be made or written
    explicit RunFolder(const std::string& path);
    RunFolder(const RunFolder&) = delete;
    RunFolder& operator=(const RunFolder&) = delete;
    ~RunFolder();  ///< Gives it back; removes it if it was made for this run and nothing is in it.

    /// Returns where the folder is now: it may have been moved since.
    /// @throws WriteError if it is gone
    const std::string& path();

    /// Writes to the folder: again if it was moved meanwhile.
    /// @param write  called with the folder's path; does the same when it is repeated
    /// @throws WriteError if the folder is gone, or as `write` does
    template <class Write>
    void write(const Write& write)
    {
        while (true) {
            const std::string folder = path();
            try {
                write(folder);
                return;
            } catch (const WriteError&) {
                if (path() == folder) throw;
            }
        }
    }

    /// Why the folder could not be locked, as on a file system without locks; empty if it was. The run goes on.
    const std::string& not_locked() const { return not_locked_; }

    /// Removes a file if it is there.
    /// @throws WriteError if that fails; InputError if it is a folder
    void remove(const std::string& name);

    /// Removes what killed runs have left of files that they were writing.
    /// @param names  of the files
    void remove_temporary_files(std::span<const std::string> names);

private:
    void lock();
    void release();

    std::string path_, not_locked_;
    bool made_ = false;
    int folder_ = -1, lock_ = -1;  ///< Descriptors.
};

}  // namespace selvage
