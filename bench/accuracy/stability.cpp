#include "bench/accuracy/stability.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <iostream>
#include <mutex>
#include <optional>

#include <fmt/format.h>
#include <tbb/task_arena.h>
#include <nlohmann/json.hpp>

#include "bench/accuracy/stability_cells.hpp"
#include "bench/harness/chart.hpp"
#include "bench/harness/machine.hpp"
#include "bench/harness/options.hpp"
#include "bench/harness/side_by_side.hpp"
#include "host/solver/stepping/integrator.hpp"
#include "io/atomic_file.hpp"

namespace selvage {
namespace {

using Json = nlohmann::ordered_json;

struct Survey {
    std::vector<StabilityResult> cells;
    std::vector<LimitResult> limits;
};

const std::vector<CellKind>& kinds()
{
    static const std::vector<CellKind> all = {{"stable", {86, 160, 96}},
                                              {"recovered", {236, 200, 84}},
                                              {"refused, with a message", {126, 156, 220}},
                                              {"gave up, with a message", {168, 128, 190}},
                                              {"slow: time limit", {200, 200, 200}},
                                              {"hung", {120, 60, 30}},
                                              {"garbage", {210, 40, 40}}};
    return all;
}

using Keep = std::function<void(const std::vector<StabilityResult>&)>;

// The files are rewritten after this number of cells, so that stopping the suite keeps the cells that are done. Chosen
// by hand; not measured.
constexpr std::size_t cells_between_files = 250;

std::vector<StabilityResult> run_cells(const std::vector<StabilityCell>& cells, const Keep& keep)
{
    std::vector<std::optional<StabilityResult>> done(cells.size());
    std::mutex access;
    const auto results = [&] {
        const std::lock_guard lock(access);
        std::vector<StabilityResult> all;
        for (std::size_t i = 0; i < done.size() && done[i]; ++i) all.push_back(*done[i]);
        return all;
    };
    run_side_by_side(
        cells.size(),
        [&](std::size_t i) {
            StabilityResult result = run_cell(cells[i]);
            const std::lock_guard lock(access);
            done[i] = std::move(result);
        },
        [&](std::size_t count) {
            if (count % 100 == 0) std::cerr << fmt::format("{} of {} cells\n", count, cells.size());
            if (count % cells_between_files == 0) keep(results());
        });
    return results();
}

Survey run_survey(bool quick, const Keep& keep)
{
    Survey survey;
    survey.cells = run_cells(stability_cells(quick), keep);
    for (const IntegratorInfo& info : integrators()) {
        if (!info.is_explicit) continue;
        for (double stiffness : {0.01, 1.0, 100.0})
            for (int resolution : quick ? std::vector<int>{16} : std::vector<int>{16, 32})
                survey.limits.push_back(measure_limit(std::string(info.name), stiffness, resolution));
    }
    return survey;
}

std::string csv_text(const std::vector<StabilityResult>& cells)
{
    std::string text =
        "integrator,step_s,stiffness,resolution,damping_per_s,self_contact,start,verdict,energy_ratio,tangled,"
        "crossed,cpu_s\n";
    for (const StabilityResult& r : cells)
        text += fmt::format("{},{:g},{:g},{},{:g},{},{},{},{:.6g},{},{},{:.4g}\n", r.cell.integrator, r.cell.step,
                            r.cell.stiffness, r.cell.resolution, r.cell.damping, int(r.cell.self_contact),
                            name_of(r.cell.start), name_of(r.verdict), r.energy_ratio, r.tangled, r.crossed, r.seconds);
    return text;
}

Json json_report(const Survey& survey)
{
    Json report;
    report["context"] = bench_context(tbb::this_task_arena::max_concurrency());
    for (const StabilityResult& r : survey.cells) {
        Json run = timed_run(fmt::format("{}/step:{:g}/stiffness:{:g}/resolution:{}/damping:{:g}/{}{}",
                                         r.cell.integrator, r.cell.step, r.cell.stiffness, r.cell.resolution,
                                         r.cell.damping, name_of(r.cell.start), r.cell.self_contact ? "/self" : ""),
                             r.seconds, r.seconds);
        run["verdict"] = name_of(r.verdict);
        run["energy_ratio"] = std::isfinite(r.energy_ratio) ? Json(r.energy_ratio) : Json();
        if (r.cell.self_contact) {
            run["tangled"] = r.tangled;
            run["crossed"] = r.crossed;
        }
        if (!r.message.empty()) run["message"] = r.message;
        report["benchmarks"].push_back(std::move(run));
    }
    for (const LimitResult& l : survey.limits)
        report["context"]["stability_limits"].push_back({{"integrator", l.integrator},
                                                         {"stiffness", l.stiffness},
                                                         {"resolution", l.resolution},
                                                         {"predicted_s", l.predicted},
                                                         {"measured_s", l.measured}});
    return report;
}

// The row label of a cell within one map: everything but the step and the resolution.
std::string row_of(const StabilityCell& cell)
{
    return fmt::format("x{:g} {} {}", cell.stiffness, name_of(cell.start), cell.damping > 0 ? "d" : "");
}

CellMap map_of(const std::vector<StabilityResult>& cells, std::string_view integrator, int resolution,
               bool self_contact)
{
    CellMap map;
    map.title = fmt::format("{}, {} a side{}", integrator, resolution, self_contact ? ", self-contact" : "");
    map.column_label = "step [s]";
    map.row_label = "stiffness, start, d: damped";
    for (const StabilityResult& r : cells) {
        const bool here = r.cell.integrator == integrator && r.cell.resolution == resolution;
        if (!here || r.cell.self_contact != self_contact) continue;
        const std::string column = power_label(r.cell.step), row = row_of(r.cell);
        if (std::find(map.columns.begin(), map.columns.end(), column) == map.columns.end())
            map.columns.push_back(column);
        if (map.rows.empty() || map.rows.back() != row) map.rows.push_back(row);
        map.kind.push_back(int(r.verdict));
    }
    return map;
}

Image picture(const Survey& survey)
{
    std::vector<Image> maps;
    const std::pair<int, bool> rows[] = {{16, false}, {32, false}, {64, false}, {128, false}, {16, true}};
    for (const auto& [resolution, self_contact] : rows)
        for (const IntegratorInfo& info : integrators()) {
            const CellMap map = map_of(survey.cells, info.name, resolution, self_contact);
            const bool complete = map.kind.size() == map.rows.size() * map.columns.size();
            if (!map.kind.empty() && complete) maps.push_back(draw_cell_map(map, kinds(), 480, 460));
        }
    const int across = int(std::count_if(integrators().begin(), integrators().end(),
                                         [](const IntegratorInfo& info) { return info.order > 0; }));
    const Image legend = draw_cell_legend(kinds(), 2400);
    return maps.empty() ? legend : stack(tile(maps, across), legend);
}

std::string table(const Survey& survey)
{
    std::string text = fmt::format("{:<20}", "integrator");
    for (int v = 0; v < verdict_count; ++v) text += fmt::format(" {:>10}", name_of(StabilityVerdict(v)));
    text += '\n';
    std::vector<int> totals(verdict_count);
    for (const IntegratorInfo& info : integrators()) {
        std::vector<int> counts(verdict_count);
        for (const StabilityResult& r : survey.cells)
            if (r.cell.integrator == info.name) ++counts[std::size_t(r.verdict)];
        if (info.order == 0) continue;
        text += fmt::format("{:<20}", info.name);
        for (int v = 0; v < verdict_count; ++v) {
            text += fmt::format(" {:>10}", counts[std::size_t(v)]);
            totals[std::size_t(v)] += counts[std::size_t(v)];
        }
        text += '\n';
    }
    text += fmt::format("{:<20}", fmt::format("all {} cells", survey.cells.size()));
    for (int v = 0; v < verdict_count; ++v) text += fmt::format(" {:>10}", totals[std::size_t(v)]);
    text += fmt::format("\n\n{:<20} {:>10} {:>10} {:>12} {:>12} {:>9}\n", "stability limit", "stiffness", "a side",
                        "predicted", "measured", "ratio");
    for (const LimitResult& l : survey.limits)
        text += fmt::format("{:<20} {:>10g} {:>10} {:>12.4g} {:>12.4g} {:>9.4f}\n", l.integrator, l.stiffness,
                            l.resolution, l.predicted, l.measured, l.measured / l.predicted);
    return text;
}

}  // namespace

void bench_stability(bool json, const std::vector<std::string>& arguments, std::ostream& out)
{
    auto options = read_options("bench stability", arguments, {"--output", "--quick"}, "--output FOLDER or --quick 1");
    const std::string folder = options.count("--output") ? options["--output"] : "bench-out";
    const bool quick = options.count("--quick") && read_number("--quick", options["--quick"], 0, 1, "0 or 1") == 1;
    std::filesystem::create_directories(folder);
    const auto keep = [&folder](const Survey& survey) {
        write_file_atomically(folder + "/stability.json", json_report(survey).dump(2) + "\n");
        write_file_atomically(folder + "/stability.csv", csv_text(survey.cells));
        write_png(folder + "/stability.png", picture(survey));
    };
    const Survey survey = run_survey(quick, [&keep](const auto& cells) { keep({cells, {}}); });
    keep(survey);
    out << (json ? json_report(survey).dump(2) + "\n" : table(survey));
    if (!json) out << folder << "/stability.png\n";
}

}  // namespace selvage
