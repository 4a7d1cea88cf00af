#pragma once
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace selvage {

/// A folder that goes away with everything in it.
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

/// One run of `selvage drape` as a process of its own, so that its memory and start-up cost are its own too.
struct ChildRun {
    int exit_code = -1;
    double wall_s = 0, cpu_s = 0;     ///< Of the whole process.
    double peak_memory_bytes = 0;     ///< Largest resident size.
    nlohmann::json summary;           ///< summary.json; null if the run left none.
    int contacts = 0;                 ///< At the end, of run.h5.
    std::vector<std::string> phases;  ///< Of a profiled run: every phase by its path,
    std::vector<double> self_s;       ///< the time of each without those within it,
    std::int64_t launches = 0;        ///< and its launches.
    std::string errors;               ///< What it printed on stderr.

    bool finished() const { return exit_code == 0; }
};

/// The file of the program that is running now.
std::string own_program();

/// Runs it to its end. What it wrote is removed.
/// @param program    file to run, such as own_program()
/// @param arguments  after `drape`; an output folder and --quiet are added
/// @throws std::runtime_error if the program cannot be started
ChildRun run_child(const std::string& program, const std::vector<std::string>& arguments);

}  // namespace selvage
