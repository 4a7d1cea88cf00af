#include "io/run/profile_report.hpp"

#include <algorithm>
#include <functional>
#include <memory>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "io/atomic_file.hpp"
#include "io/run/hdf5_file.hpp"

namespace selvage {
namespace {

std::string path_of(const ProfileReport& report, int row)
{
    const ProfileRow& r = report.rows[std::size_t(row)];
    return r.parent < 0 ? r.name : path_of(report, r.parent) + "/" + r.name;
}

double copy_fraction(const ProfileReport& report, const ProfileRow& row)
{
    return double(row.bytes) / row.total_s / report.copy_bytes_per_second;
}

// Returns the rows in depth-first order; of siblings the one with the longest total time comes first.
std::vector<int> tree_order(const ProfileReport& report)
{
    std::vector<std::vector<int>> children(report.rows.size());
    std::vector<int> order, roots;
    for (int r = 0; r < int(report.rows.size()); ++r) {
        const int parent = report.rows[std::size_t(r)].parent;
        (parent < 0 ? roots : children[std::size_t(parent)]).push_back(r);
    }
    const std::function<void(std::vector<int>&)> visit = [&](std::vector<int>& siblings) {
        std::stable_sort(siblings.begin(), siblings.end(), [&](int a, int b) {
            return report.rows[std::size_t(a)].total_s > report.rows[std::size_t(b)].total_s;
        });
        for (int r : siblings) {
            order.push_back(r);
            visit(children[std::size_t(r)]);
        }
    };
    visit(roots);
    return order;
}

std::string machine_lines(const ProfileReport& report)
{
    const MachineInfo& m = report.machine;
    return fmt::format("selvage {}, {}, {}\n{}\n{}, {} cores, {} threads, {:.1f} GiB, copies {:.2f} GB/s\n\n",
                       m.version, m.compiler, m.build_type, m.flags, m.cpu_name, m.cores, report.threads,
                       double(m.memory_bytes) / (1 << 30), 1e-9 * report.copy_bytes_per_second);
}

nlohmann::ordered_json machine_json(const ProfileReport& report)
{
    const MachineInfo& m = report.machine;
    return {{"version", m.version},
            {"compiler", m.compiler},
            {"flags", m.flags},
            {"build_type", m.build_type},
            {"cpu_name", m.cpu_name},
            {"num_cpus", m.cores},
            {"threads", report.threads},
            {"memory_bytes", m.memory_bytes},
            {"copy_bytes_per_second", report.copy_bytes_per_second}};
}

}  // namespace

std::string profile_table(const ProfileReport& report)
{
    std::string text = machine_lines(report);
    text += fmt::format("{:<44} {:>8} {:>9} {:>9} {:>10} {:>10} {:>6} {:>7} {:>7} {:>8}\n", "phase", "calls", "total s",
                        "self s", "p50 ms", "p95 ms", "busy", "GB/s", "of copy", "GFLOP/s");
    for (int r : tree_order(report)) {
        const ProfileRow& row = report.rows[std::size_t(r)];
        text += fmt::format("{:<44} {:>8} {:>9.3f} {:>9.3f} {:>10.4f} {:>10.4f} {:>5.0f}%",
                            std::string(2 * std::size_t(row.depth), ' ') + row.name, row.calls, row.total_s, row.self_s,
                            1e3 * row.p50_s, 1e3 * row.p95_s, 100 * row.busy_s / (row.total_s * report.threads));
        if (row.bytes > 0)
            text += fmt::format(" {:>7.2f} {:>6.0f}%", 1e-9 * double(row.bytes) / row.total_s,
                                100 * copy_fraction(report, row));
        if (row.flops > 0) text += fmt::format(" {:>8.2f}", 1e-9 * double(row.flops) / row.total_s);
        text += '\n';
    }
    return text +
           "busy: time in shared tasks over time and threads; of copy: bytes that must move, over seconds, against "
           "the machine's copy speed (above 100 %: from the caches)\n";
}

void write_chrome_trace(const std::string& path, const ProfileReport& report)
{
    nlohmann::ordered_json about = machine_json(report);
    std::string text =
        "{\"displayTimeUnit\": \"ms\",\n\"traceEvents\": [\n"
        "{\"ph\": \"M\", \"name\": \"process_name\", \"pid\": 1, \"tid\": 0, \"args\": {\"name\": \"selvage\"}}";
    for (std::size_t t = 0; t < report.tracks.size(); ++t) {
        const ProfileTrack& track = report.tracks[t];
        text += fmt::format(
            ",\n{{\"ph\": \"M\", \"name\": \"thread_name\", \"pid\": 1, \"tid\": {}, \"args\": {{\"name\": {}}}}}", t,
            nlohmann::json(track.thread).dump());
        if (track.left_out > 0)
            about["left_out"].push_back(
                {{"thread", track.thread}, {"events", track.left_out}, {"shorter_than_s", track.shortest_s}});
        for (const ProfileEvent& event : track.events)
            text += fmt::format(
                ",\n{{\"ph\": \"X\", \"name\": {}, \"cat\": \"{}\", \"pid\": 1, \"tid\": {}, \"ts\": {}.{:03}, "
                "\"dur\": {}.{:03}}}",
                nlohmann::json(report.rows[std::size_t(event.row)].name).dump(), event.task ? "task" : "phase", t,
                event.begin / 1000, event.begin % 1000, (event.end - event.begin) / 1000,
                (event.end - event.begin) % 1000);
    }
    write_file_atomically(path, text + "\n],\n\"otherData\": " + about.dump() + "}\n");
}

void write_profile(const std::string& run_path, const ProfileReport& report)
{
    Hdf5File file(run_path, Hdf5Access::append);
    const std::string group = "/selvage/profile";
    file.make_group(group);
    std::vector<std::string> names;
    for (int r = 0; r < int(report.rows.size()); ++r) names.push_back(path_of(report, r));
    file.set_texts(group, "phase", names);
    const auto add = [&](const char* name, auto ProfileRow::*member) {
        using Stored =
            std::conditional_t<std::is_integral_v<std::decay_t<decltype(ProfileRow{}.*member)>>, std::int64_t, double>;
        std::vector<Stored> values;
        for (const ProfileRow& row : report.rows) values.push_back(Stored(row.*member));
        file.write(group + "/" + name, std::is_same_v<Stored, double> ? H5T_IEEE_F64LE : H5T_STD_I64LE, {values.size()},
                   std::span<const Stored>(values));
    };
    add("parent", &ProfileRow::parent);
    add("calls", &ProfileRow::calls);
    add("launches", &ProfileRow::launches);
    add("total_s", &ProfileRow::total_s);
    add("self_s", &ProfileRow::self_s);
    add("p50_s", &ProfileRow::p50_s);
    add("p95_s", &ProfileRow::p95_s);
    add("busy_s", &ProfileRow::busy_s);
    add("bytes", &ProfileRow::bytes);
    add("flops", &ProfileRow::flops);
    const nlohmann::ordered_json machine = machine_json(report);
    for (const auto& [key, value] : machine.items()) {
        if (value.is_string())
            file.set_text(group, key.c_str(), value.get<std::string>());
        else if (value.is_number_integer())
            file.set_integer(group, key.c_str(), value.get<std::int64_t>());
        else
            file.set_real(group, key.c_str(), value.get<double>());
    }
    file.close();
}

}  // namespace selvage
