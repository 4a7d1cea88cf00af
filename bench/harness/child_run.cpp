#include "bench/harness/child_run.hpp"

#include <chrono>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include <fcntl.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "io/run/hdf5_reader.hpp"
#include "io/run/trajectory.hpp"

extern char** environ;

namespace selvage {
namespace {

namespace fs = std::filesystem;

std::string text_of(const std::string& path)
{
    std::ostringstream text;
    text << std::ifstream(path).rdbuf();
    return text.str();
}

void read_run(const std::string& path, ChildRun& run)
{
    {
        const TrajectoryReader reader(path);
        if (const int last = reader.frame_count() - 1; last >= 0) {
            run.contacts = reader.scalars(last).contacts;
            run.positions = reader.read_frame(last);
        }
    }
    const Hdf5Reader file(path);
    if (!file.exists("/selvage/profile")) return;
    run.phases = file.texts("/selvage/profile", "phase");
    run.self_s = file.read_reals("/selvage/profile/self_s");
    for (std::int64_t launches : file.read_integers("/selvage/profile/launches")) run.launches += launches;
}

// Starts a process whose standard output and standard error both go to one file, so that the terminal's speed does not
// enter the measurement.
pid_t start(std::vector<std::string> arguments, const std::string& log)
{
    std::vector<char*> words;
    for (std::string& argument : arguments) words.push_back(argument.data());
    words.push_back(nullptr);
    posix_spawn_file_actions_t streams;
    posix_spawn_file_actions_init(&streams);
    posix_spawn_file_actions_addopen(&streams, STDOUT_FILENO, log.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    posix_spawn_file_actions_adddup2(&streams, STDOUT_FILENO, STDERR_FILENO);
    pid_t child = -1;
    const int fault = posix_spawn(&child, words.front(), &streams, nullptr, words.data(), environ);
    posix_spawn_file_actions_destroy(&streams);
    if (fault != 0) throw std::runtime_error("cannot run " + arguments.front());
    return child;
}

double seconds(const timeval& time) { return double(time.tv_sec) + 1e-6 * double(time.tv_usec); }

}  // namespace

WorkFolder::WorkFolder()
{
    std::string pattern = (fs::temp_directory_path() / "selvage_bench_XXXXXX").string();
    if (!mkdtemp(pattern.data()))
        throw std::runtime_error("cannot make a folder in " + fs::temp_directory_path().string());
    path_ = pattern;
}

WorkFolder::~WorkFolder()
{
    std::error_code ignored;
    fs::remove_all(path_, ignored);
}

std::string own_program() { return fs::read_symlink("/proc/self/exe").string(); }

ChildRun run_child(const std::string& program, const std::vector<std::string>& arguments, const std::string& folder)
{
    const WorkFolder scratch;
    const std::string out = folder.empty() ? scratch.file("out") : folder, log = scratch.file("log");
    std::vector<std::string> words = {program, "drape"};
    words.insert(words.end(), arguments.begin(), arguments.end());
    for (const std::string& word : {std::string("--quiet"), std::string("-o"), out}) words.push_back(word);

    ChildRun run;
    const auto begin = std::chrono::steady_clock::now();
    const pid_t child = start(words, log);
    int status = 0;
    rusage usage{};
    while (wait4(child, &status, 0, &usage) < 0)
        if (errno != EINTR) throw std::runtime_error("lost the run of " + program);
    run.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    run.cpu_s = seconds(usage.ru_utime) + seconds(usage.ru_stime);
    run.peak_memory_bytes = 1024 * double(usage.ru_maxrss);
    run.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    run.errors = text_of(log);
    if (fs::exists(out + "/summary.json")) run.summary = nlohmann::json::parse(text_of(out + "/summary.json"));
    if (fs::exists(out + "/run.h5")) read_run(out + "/run.h5", run);
    return run;
}

}  // namespace selvage
