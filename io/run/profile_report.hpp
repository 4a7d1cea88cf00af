#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "io/machine.hpp"

namespace selvage {

/// What one phase of a run cost, or a part of a phase.
struct ProfileRow {
    std::string name;
    int parent = -1, depth = 0;  ///< Row of the phase that it is part of; a row stands after its parent.
    std::int64_t calls = 0;
    std::int64_t launches = 0;          ///< Of work that is shared among threads, without those of its parts.
    double total_s = 0, self_s = 0;     ///< Self: without the parts below it.
    double p50_s = 0, p95_s = 0;        ///< Of one call.
    double busy_s = 0;                  ///< In tasks of all threads, parts included.
    std::int64_t bytes = 0, flops = 0;  ///< That it must move and compute, over all calls; 0: not known.
};

/// A span on the track of one thread, [ns] since the start.
struct ProfileEvent {
    std::int64_t begin = 0, end = 0;
    int row = 0;
    bool task = false;  ///< Work that was shared among threads; false: the phase itself.
};

struct ProfileTrack {
    std::string thread;
    std::vector<ProfileEvent> events;  ///< Properly nested; outer ones before inner ones.
    std::int64_t left_out = 0;         ///< Events that were too short to be kept,
    double shortest_s = 0;             ///< that is, below this.
};

/// The profile of a run.
struct ProfileReport {
    MachineInfo machine;
    int threads = 1;
    double copy_bytes_per_second = 0;  ///< Of the machine with these threads, measured.
    std::vector<ProfileRow> rows;
    std::vector<ProfileTrack> tracks;
};

/// The rows as a table, indented by depth, and below it what binds those whose traffic is known.
std::string profile_table(const ProfileReport& report);

/// Writes the tracks as a Chrome trace, which Perfetto and chrome://tracing open.
/// @throws InputError if the file cannot be written
void write_chrome_trace(const std::string& path, const ProfileReport& report);

/// Adds the rows and the machine to a finished run.h5 that has no profile yet, under /selvage/profile.
/// @throws InputError if the file cannot be opened
void write_profile(const std::string& run_path, const ProfileReport& report);

}  // namespace selvage
