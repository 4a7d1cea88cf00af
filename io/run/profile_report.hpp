#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "io/machine.hpp"

namespace selvage {

/// The cost of one phase of a run, or of a part of a phase.
struct ProfileRow {
    std::string name;
    int parent = -1, depth = 0;  ///< `parent` is the row of the phase that it is part of; parents come first.
    std::int64_t calls = 0;
    std::int64_t launches = 0;          ///< Parallel loops that it started, without those of its parts.
    double total_s = 0, self_s = 0;     ///< `self_s` is without its parts.
    double p50_s = 0, p95_s = 0;        ///< Percentiles of the time of one call.
    double busy_s = 0;                  ///< Time in tasks, summed over all threads, its parts included.
    std::int64_t bytes = 0, flops = 0;  ///< Necessary traffic and arithmetic of all calls; 0: not known.
};

/// A time span on the track of one thread, in [ns] since the start of the run.
struct ProfileEvent {
    std::int64_t begin = 0, end = 0;
    int row = 0;
    bool task = false;  ///< True: a task of a parallel loop; false: the phase itself.
};

struct ProfileTrack {
    std::string thread;
    std::vector<ProfileEvent> events;  ///< Properly nested; outer ones before inner ones.
    std::int64_t left_out = 0;         ///< Number of events that were too short to be kept.
    double shortest_s = 0;             ///< The length below which an event was too short [s].
};

/// The profile of a run.
struct ProfileReport {
    MachineInfo machine;
    int threads = 1;
    double copy_bytes_per_second = 0;  ///< Measured copy bandwidth of the machine with this number of threads.
    std::vector<ProfileRow> rows;
    std::vector<ProfileTrack> tracks;
};

/// Returns the rows as a table, indented by depth, with bandwidths and arithmetic rates where they are known.
std::string profile_table(const ProfileReport& report);

/// Writes the tracks as a Chrome trace, which Perfetto and chrome://tracing open.
/// @throws InputError if the file cannot be written
void write_chrome_trace(const std::string& path, const ProfileReport& report);

/// Adds the rows and the machine to a finished run.h5 that has no profile yet, under /selvage/profile.
/// @throws InputError if the file cannot be opened
void write_profile(const std::string& run_path, const ProfileReport& report);

}  // namespace selvage
