#pragma once
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "io/geometry.hpp"

namespace selvage {

/// A temporary folder; the destructor removes it with everything in it.
class WorkFolder {
public:
    WorkFolder();
    WorkFolder(const WorkFolder&) = delete;
    WorkFolder& operator=(const WorkFolder&) = delete;
    ~WorkFolder();
    const std::string& path() const { return path_; }
    std::string file(const std::string& name) const { return path_ + "/" + name; }

private:
    std::string path_;
};

/// One run of `selvage drape` in a process of its own, so that its memory and its start-up cost can be measured.
struct ChildRun {
    int exit_code = -1;
    double wall_s = 0, cpu_s = 0;     ///< Of the whole process.
    double peak_memory_bytes = 0;     ///< Largest resident size.
    nlohmann::json summary;           ///< summary.json; null if the run left none.
    int contacts = 0;                 ///< Vertices in contact in the last frame of run.h5.
    std::vector<Vec3> positions;      ///< Per point of the last frame of run.h5 [m].
    std::vector<std::string> phases;  ///< Path of every phase; empty unless the run was profiled.
    std::vector<double> self_s;       ///< Time of each phase without the phases within it.
    std::int64_t launches = 0;        ///< Kernel launches of all phases; 0 unless the run was profiled.
    std::string errors;               ///< What the run printed on stderr.

    bool finished() const { return exit_code == 0; }
};

/// Returns the path of the program that is running now.
std::string own_program();

/// Runs `program drape` to its end.
/// @param program    file to run, such as own_program()
/// @param arguments  after `drape`; an output folder and --quiet are added
/// @param folder     where its output stays; empty: it is removed
/// @throws std::runtime_error if the program cannot be started
ChildRun run_child(const std::string& program, const std::vector<std::string>& arguments,
                   const std::string& folder = {});

}  // namespace selvage
