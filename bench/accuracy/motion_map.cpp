#include "bench/accuracy/motion_map.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>

#include <fmt/format.h>
#include <tbb/task_arena.h>
#include <nlohmann/json.hpp>

#include "bench/accuracy/motion_cells.hpp"
#include "bench/harness/chart.hpp"
#include "bench/harness/machine.hpp"
#include "bench/harness/options.hpp"
#include "bench/harness/side_by_side.hpp"
#include "host/solver/stepping/integrator.hpp"
#include "io/atomic_file.hpp"

namespace selvage {
namespace {

using Json = nlohmann::ordered_json;

struct MotionSurvey {
    std::vector<MotionResult> runs;
    double largest_difference = 0;  // between the two references of a sheet, over its side [1]
    MotionModel least_certain;      // the sheet where that is
};

const std::vector<CellKind>& kinds()
{
    static const std::vector<CellKind> all = {{"accurate: within 5 % of the side", {86, 160, 96}},
                                              {"rough: within 10 %", {200, 214, 96}},
                                              {"less, and the program says so", {126, 156, 220}},
                                              {"less, and it does not", {210, 40, 40}}};
    return all;
}

std::string name_of(const MotionModel& m)
{
    return fmt::format("{:g} mm, {} N/m, {} N m", 1000 * m.edge, power_label(m.stretch), power_label(m.bending));
}

// The same, short enough for a picture.
std::string row_of(const MotionModel& m)
{
    return fmt::format("{:g} {} {}", 1000 * m.edge, power_label(m.stretch), power_label(m.bending));
}

void add_sheet(const MotionModel& model, MotionSurvey& survey)
{
    const MotionReference reference = motion_reference(model);
    if (reference.difference >= survey.largest_difference) {
        survey.largest_difference = reference.difference;
        survey.least_certain = model;
    }
    const std::vector<MotionCell> cells = motion_cells(model);
    const std::size_t first = survey.runs.size();
    survey.runs.resize(first + cells.size());
    run_side_by_side(
        cells.size(), [&](std::size_t i) { survey.runs[first + i] = run_motion(cells[i], reference); },
        [](std::size_t) {});
    std::cerr << fmt::format("{}: done; its references differ by {:.2g} of its side\n", name_of(model),
                             reference.difference);
}

std::string csv_text(const std::vector<MotionResult>& runs)
{
    std::string text =
        "integrator,step_s,stretch_n_per_m,bending_n_m,edge_m,verdict,error,largest_estimate,exit_code,cpu_s\n";
    for (const MotionResult& r : runs) {
        const MotionModel& m = r.cell.model;
        text +=
            fmt::format("{},{:g},{:g},{:g},{:g},{},{:.4g},{:.4g},{},{:.3g}\n", r.cell.integrator, r.cell.step,
                        m.stretch, m.bending, m.edge, name_of(r.verdict), r.error, r.estimate, r.exit_code, r.seconds);
    }
    return text;
}

Json number(double value) { return std::isfinite(value) ? Json(value) : Json(); }

Json json_report(const MotionSurvey& survey)
{
    Json report;
    report["context"] = bench_context(tbb::this_task_arena::max_concurrency());
    report["context"]["largest_difference_of_references"] = {{"sheet", name_of(survey.least_certain)},
                                                             {"over_side", survey.largest_difference}};
    report["benchmarks"] = Json::array();
    for (const MotionResult& r : survey.runs) {
        const MotionModel& m = r.cell.model;
        Json run = timed_run(fmt::format("{}/step:{:g}/stretch:{:g}/bending:{:g}/edge:{:g}", r.cell.integrator,
                                         r.cell.step, m.stretch, m.bending, m.edge),
                             r.seconds, r.seconds);
        run["verdict"] = name_of(r.verdict);
        run["error"] = number(r.error);
        run["largest_estimate"] = number(r.estimate);
        run["exit_code"] = r.exit_code;
        if (!r.message.empty()) run["message"] = r.message;
        report["benchmarks"].push_back(std::move(run));
    }
    return report;
}

CellMap map_of(const std::vector<MotionResult>& runs, std::string_view integrator)
{
    CellMap map;
    map.title = integrator;
    map.column_label = "step [s]";
    map.row_label = "edge [mm], stretch [N/m], bending [N m]";
    for (const MotionResult& r : runs) {
        if (r.cell.integrator != integrator) continue;
        const std::string column = power_label(r.cell.step), row = row_of(r.cell.model);
        if (std::find(map.columns.begin(), map.columns.end(), column) == map.columns.end())
            map.columns.push_back(column);
        if (map.rows.empty() || map.rows.back() != row) map.rows.push_back(row);
        map.kind.push_back(int(r.verdict));
    }
    return map;
}

Image picture(const MotionSurvey& survey)
{
    std::vector<Image> maps;
    for (const IntegratorInfo& info : integrators())
        if (const CellMap map = map_of(survey.runs, info.name); !map.kind.empty())
            maps.push_back(draw_cell_map(map, kinds(), 480, 560));
    return stack(tile(maps, 4), draw_cell_legend(kinds(), 1920));
}

std::string table(const MotionSurvey& survey)
{
    std::string text = fmt::format("{:<20}", "integrator");
    for (int v = 0; v < motion_verdicts; ++v) text += fmt::format(" {:>10}", name_of(MotionVerdict(v)));
    text += fmt::format(" {:>16}\n", "largest silent");
    for (const IntegratorInfo& info : integrators()) {
        if (info.order == 0) continue;
        std::vector<int> counts(motion_verdicts);
        double largest = 0;  // error of the runs that end without a word
        for (const MotionResult& r : survey.runs) {
            if (r.cell.integrator != info.name) continue;
            ++counts[std::size_t(r.verdict)];
            if (r.verdict != MotionVerdict::said) largest = std::max(largest, r.error);
        }
        text += fmt::format("{:<20}", info.name);
        for (int count : counts) text += fmt::format(" {:>10}", count);
        text += fmt::format(" {:>14.2g} %\n", 100 * largest);
    }
    return text + fmt::format("{} runs; the references of a sheet differ by at most {:.2g} % of its side ({})\n",
                              survey.runs.size(), 100 * survey.largest_difference, name_of(survey.least_certain));
}

}  // namespace

void bench_motion(bool json, const std::vector<std::string>& arguments, std::ostream& out)
{
    auto options = read_options("bench motion", arguments, {"--output", "--quick"}, "--output FOLDER or --quick 1");
    const std::string folder = options.count("--output") ? options["--output"] : "bench-out";
    const bool quick = options.count("--quick") && read_number("--quick", options["--quick"], 0, 1, "0 or 1") == 1;
    std::filesystem::create_directories(folder);
    MotionSurvey survey;
    for (const MotionModel& model : motion_models(quick)) {
        add_sheet(model, survey);
        // The files are rewritten after each sheet, so that stopping the suite keeps those that are done.
        write_file_atomically(folder + "/motion.json", json_report(survey).dump(2) + "\n");
        write_file_atomically(folder + "/motion.csv", csv_text(survey.runs));
        write_png(folder + "/motion.png", picture(survey));
    }
    out << (json ? json_report(survey).dump(2) + "\n" : table(survey));
    if (!json) out << folder << "/motion.png\n";
}

}  // namespace selvage
