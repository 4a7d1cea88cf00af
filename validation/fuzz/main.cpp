// Feeds changed inputs to every reader of files: selvage_fuzz [TARGET...] [--executions N] [--seconds S] [--seed N]
// [--verbose]. The same seed gives the same inputs. A fault is any end other than a return or InputError, a leak (under
// the address sanitiser), and more than 5 s or 1 GB; what hangs is killed after 20 s. The input is kept. The exit code
// is 1 if there was one.
#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <filesystem>
#include <fstream>
#include <stdexcept>

#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "io/errors.hpp"
#include "validation/fuzz/targets.hpp"

using namespace selvage;

namespace {

// Sanitisers slow the solver down by five and more.
#ifdef __SANITIZE_ADDRESS__
constexpr double slowdown = 6;
#else
constexpr double slowdown = 1;
#endif
constexpr double most_seconds = 5 * slowdown;               // of processor time, as others may compute beside it
constexpr unsigned killed_after = unsigned(20 * slowdown);  // [s]
constexpr long most_kilobytes = 1 << 20;
constexpr long batch = 2000;  // executions of one process, so that a crash ends few of them

struct Options {
    std::vector<std::string> names;
    long executions = 200;  ///< Of each target.
    double seconds = 1e9;   ///< For each target.
    std::uint64_t seed = 1;
    bool verbose = false;  ///< Print why inputs were refused.
};

/// What a process that executes tells the one that waits for it, in shared memory.
struct Progress {
    long current, done, refused, slowest, largest;
    double slowest_seconds;
    long most_kilobytes;
    char fault[200];
};

struct Tally {
    long executions = 0, refused = 0, faults = 0, leaks = 0, slowest = -1, largest = -1, kilobytes = 0;
    double slowest_seconds = 0;
};

double now() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

// What the threads of this process have computed so far [s].
double processor_seconds()
{
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    const auto seconds = [](const timeval& time) { return double(time.tv_sec) + 1e-6 * double(time.tv_usec); };
    return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

long peak_kilobytes()
{
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return usage.ru_maxrss;
}

std::string input_of(const FuzzTarget& target, std::uint64_t seed, long index)
{
    // The inputs of the corpus come first as they are.
    if (std::size_t(index) < target.corpus.size()) return target.corpus[std::size_t(index)];
    Chance chance(seed * 1000003 + std::uint64_t(index));
    const std::string& start = target.corpus[below(target.corpus.size(), chance)];
    std::string input = target.binary ? mutated_bytes(start, chance) : mutated_text(start, target.corpus, chance);
    if (target.seal && index % 2 == 0) target.seal(input);
    return input;
}

void execute(const FuzzTarget& target, const std::string& path, const Options& options, long index, Progress& progress)
{
    std::filesystem::remove(path);  // some file systems wait for the disk where a file is written over
    std::ofstream(path, std::ios::binary) << input_of(target, options.seed, index);
    progress.current = index;
    const double begin = processor_seconds();
    alarm(killed_after);
    try {
        target.read(path);
    } catch (const InputError& fault) {
        ++progress.refused;
        if (options.verbose) std::printf("%s: input %ld: %s\n", target.name.c_str(), index, fault.what());
    } catch (const std::exception& fault) {
        std::snprintf(progress.fault, sizeof progress.fault, "threw: %s", fault.what());
        std::exit(2);
    }
    alarm(0);
    const double seconds = processor_seconds() - begin;
    if (seconds > progress.slowest_seconds) progress.slowest_seconds = seconds, progress.slowest = index;
    if (peak_kilobytes() > progress.most_kilobytes)
        progress.most_kilobytes = peak_kilobytes(), progress.largest = index;
    ++progress.done;
    if (seconds > most_seconds || progress.most_kilobytes > most_kilobytes) {
        std::snprintf(progress.fault, sizeof progress.fault, "took %.1f s and %ld MB", seconds,
                      progress.most_kilobytes / 1024);
        std::exit(2);
    }
}

void keep(const FuzzTarget& target, const Options& options, long index, const std::string& what)
{
    const std::string name = "fuzz_" + target.name + "_" + std::to_string(options.seed) + "_" + std::to_string(index);
    std::ofstream(name, std::ios::binary) << input_of(target, options.seed, index);
    std::printf("%s: input %ld %s; kept as %s\n", target.name.c_str(), index, what.c_str(), name.c_str());
}

// Executes inputs in a process of its own; returns the index after the last one that was tried.
long run_batch(const FuzzTarget& target, const std::string& path, const Options& options, long first, long end,
               Progress& progress, Tally& tally)
{
    progress = {};
    std::fflush(nullptr);
    const pid_t child = fork();
    if (child < 0) throw std::runtime_error("no further process");
    if (child == 0) {
        for (long index = first; index < end; ++index) execute(target, path, options, index, progress);
        progress.current = end;
        std::exit(0);  // the sanitiser looks for leaks on the way
    }
    int status = 0;
    waitpid(child, &status, 0);
    tally.executions += progress.done;
    tally.refused += progress.refused;
    if (progress.slowest_seconds > tally.slowest_seconds)
        tally.slowest_seconds = progress.slowest_seconds, tally.slowest = progress.slowest;
    if (progress.most_kilobytes > tally.kilobytes)
        tally.kilobytes = progress.most_kilobytes, tally.largest = progress.largest;
    if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return end;
    if (progress.current == end) {
        ++tally.leaks;
        std::printf("%s: a leak among inputs %ld to %ld\n", target.name.c_str(), first, end - 1);
        return end;
    }
    ++tally.faults;
    const int signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
    const std::string how = signal == SIGALRM ? "hung" : signal ? strsignal(signal) : "ended the process";
    keep(target, options, progress.current, progress.fault[0] ? progress.fault : how);
    return progress.current + 1;
}

Tally run_target(const FuzzTarget& target, const std::string& folder, const Options& options, Progress& progress)
{
    Tally tally;
    const double begin = now();
    for (long index = 0; index < options.executions && now() - begin < options.seconds && tally.faults < 20;)
        index = run_batch(target, folder + "/" + target.file_name, options, index,
                          std::min(index + batch, options.executions), progress, tally);
    std::printf(
        "%-10s %8ld executions, %8ld refused, %ld faults, %ld leaks; slowest %.3f s (%ld), largest %ld MB (%ld), "
        "%.1f s\n",
        target.name.c_str(), tally.executions, tally.refused, tally.faults, tally.leaks, tally.slowest_seconds,
        tally.slowest, tally.kilobytes / 1024, tally.largest, now() - begin);
    std::fflush(stdout);
    return tally;
}

Options read_options(int count, char** words)
{
    Options options;
    for (int k = 1; k < count; ++k) {
        const std::string word = words[k], value = k + 1 < count ? words[k + 1] : "";
        if (word == "--verbose") {
            options.verbose = true;
            continue;
        }
        if (!word.starts_with("--")) {
            options.names.push_back(word);
            continue;
        }
        if (word == "--executions")
            options.executions = std::stol(value);
        else if (word == "--seconds")
            options.seconds = std::stod(value);
        else if (word == "--seed")
            options.seed = std::stoull(value);
        else
            throw std::runtime_error("options: [TARGET...] --executions N --seconds S --seed N --verbose");
        ++k;
    }
    return options;
}

int fuzz(const Options& options, const std::string& folder)
{
    void* shared = mmap(nullptr, sizeof(Progress), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (shared == MAP_FAILED) throw std::runtime_error("no shared memory");
    Progress& progress = *new (shared) Progress{};
    long executions = 0, faults = 0;
    for (const FuzzTarget& target : fuzz_targets(folder)) {
        if (!options.names.empty() && std::ranges::count(options.names, target.name) == 0) continue;
        const Tally tally = run_target(target, folder, options, progress);
        executions += tally.executions;
        faults += tally.faults + tally.leaks;
    }
    std::printf("%ld executions, %ld faults\n", executions, faults);
    return faults == 0 ? 0 : 1;
}

}  // namespace

int main(int count, char** words)
try {
    std::string folder = (std::filesystem::temp_directory_path() / "selvage_fuzz_XXXXXX").string();
    if (!mkdtemp(folder.data())) throw std::runtime_error("no folder for inputs");
    const int code = fuzz(read_options(count, words), folder);
    std::filesystem::remove_all(folder);
    return code;
} catch (const std::exception& fault) {
    std::fprintf(stderr, "%s\n", fault.what());
    return 1;
}
