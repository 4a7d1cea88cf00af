#include "bench/accuracy/work_precision.hpp"

#include <filesystem>
#include <iostream>

#include <fmt/format.h>
#include <tbb/task_arena.h>
#include <nlohmann/json.hpp>

#include "bench/accuracy/precision_front.hpp"
#include "bench/harness/chart.hpp"
#include "bench/harness/machine.hpp"
#include "bench/harness/options.hpp"
#include "host/scene/run_settings.hpp"
#include "io/atomic_file.hpp"

namespace selvage {
namespace {

using Json = nlohmann::ordered_json;

struct Measured {
    std::vector<PrecisionScene> scenes;
    std::vector<PrecisionReference> references;
    std::vector<std::string> standards;  // per scene: the method that `drape` would choose by default
    std::vector<PrecisionPoint> points;
};

void measure_scene(const PrecisionScene& scene, bool quick, Measured& to)
{
    SceneRunner runner(scene.source, scene.overrides);
    std::cerr << scene.name << ": reference\n";
    PrecisionReference reference = find_reference(runner, scene);
    const auto& start = runner.model().cloth_model.cloth.positions;
    const double until = scene.at_rest ? 0 : std::stod(runner.scene().solver.until);
    double limit = 0;
    tbb::task_arena alone(1);
    {
        Phase phase = runner.make_phase(false);
        if (phase.contact()) phase.contact()->update(phase.state());
        limit = make_integrator("symplectic_euler", phase)->stable_step();
    }
    for (const RunSetting& setting : precision_settings(scene, until, limit, quick)) {
        std::cerr << fmt::format("{}: {} step {:.3g} s\n", scene.name, setting.integrator, setting.step);
        PrecisionPoint point{scene.name, method_name(setting.integrator, setting.step_error > 0), setting, {}, 0};
        // Each run has one thread and is judged by its CPU time. Small scenes gain little from more threads, and CPU
        // time does not depend on other programs.
        alone.execute([&] { point.result = runner.run(setting); });
        // A run is never compared with a reference by the same integrator.
        const bool own = setting.integrator == reference.integrator;
        point.error = position_error(point.result.positions, own ? reference.other : reference.positions, start);
        point.result.positions.clear();
        to.points.push_back(std::move(point));
    }
    to.standards.push_back(text_of(integrator_of(runner.scene(), runner.model().cloth_model)));
    to.scenes.push_back(scene);
    to.references.push_back(std::move(reference));
}

std::string csv_text(const std::vector<PrecisionPoint>& points)
{
    std::string text =
        "scene,method,step_s,step_error_m,tolerance,step_tolerance,precision,cpu_s,wall_s,position_error,steps,"
        "newton_iterations,linear_iterations,finished\n";
    for (const PrecisionPoint& p : points)
        text +=
            fmt::format("{},\"{}\",{:.6g},{:g},{:g},{:g},{},{:.6g},{:.6g},{:.6g},{},{},{},{}\n", p.scene, p.method,
                        p.setting.step, p.setting.step_error, p.setting.tolerance, p.setting.step_tolerance,
                        p.setting.float_solves ? "float" : "double", p.result.cpu, p.result.wall, p.error,
                        p.result.steps, p.result.newton_iterations, p.result.linear_iterations, int(p.result.finished));
    return text;
}

Json json_point(const PrecisionPoint& p)
{
    Json run = timed_run(fmt::format("{}/{}/step:{:.3g}/step_error:{:g}/tolerance:{:g}/step_tolerance:{:g}/{}", p.scene,
                                     p.method, p.setting.step, p.setting.step_error, p.setting.tolerance,
                                     p.setting.step_tolerance, p.setting.float_solves ? "float" : "double"),
                         p.result.wall, p.result.cpu);
    run["position_error"] = std::isfinite(p.error) ? Json(p.error) : Json();
    run["steps"] = p.result.steps;
    run["newton_iterations"] = p.result.newton_iterations;
    run["linear_iterations"] = p.result.linear_iterations;
    run["finished"] = p.result.finished;
    if (!p.result.message.empty()) run["message"] = p.result.message;
    return run;
}

std::string reference_line(const PrecisionScene& scene, const PrecisionReference& r)
{
    return fmt::format("{}: reference {} at {:.3g} s ({:.0f} s of work), {:.1e} from its run at {}, {:.1e} from {}\n",
                       scene.name, r.integrator, r.step, r.seconds, r.refined_change,
                       scene.at_rest ? "ten times the tolerance" : "twice the step", r.difference, r.other_integrator);
}

Json json_report(const Measured& measured)
{
    Json report;
    report["context"] = bench_context(tbb::this_task_arena::max_concurrency());
    for (std::size_t s = 0; s < measured.scenes.size(); ++s) {
        const PrecisionReference& r = measured.references[s];
        report["context"]["references"][measured.scenes[s].name] = {{"integrator", r.integrator},
                                                                    {"step_s", r.step},
                                                                    {"change_from_coarser", r.refined_change},
                                                                    {"other_integrator", r.other_integrator},
                                                                    {"difference", r.difference}};
        report["context"]["verdicts"][measured.scenes[s].name] = verdict_sentence(
            fronts(measured.points, measured.scenes[s].name), measured.scenes[s].name, measured.standards[s]);
    }
    report["benchmarks"] = Json::array();
    for (const PrecisionPoint& point : measured.points) report["benchmarks"].push_back(json_point(point));
    return report;
}

Image diagram(const Measured& measured)
{
    std::vector<std::string> names;
    // Eight with fixed steps come first, as many as there are colours: the same with adaptive ones then has its colour.
    for (bool adaptive : {false, true})
        for (const IntegratorInfo& info : integrators()) names.push_back(method_name(info.name, adaptive));
    std::vector<Image> charts;
    for (const PrecisionScene& scene : measured.scenes) {
        LogChart chart{scene.title, "CPU time, one thread [s]", "position error / way", {}, 0.01, "1 %"};
        for (const PrecisionFront& front : fronts(measured.points, scene.name))
            chart.series.push_back({front.method, front.seconds, front.error});
        charts.push_back(draw_log_chart(chart, names, 820, 460));
    }
    return tile(charts, std::min(2, int(charts.size())));
}

std::string table(const Measured& measured)
{
    std::string text;
    for (std::size_t s = 0; s < measured.scenes.size(); ++s) {
        const PrecisionScene& scene = measured.scenes[s];
        text += reference_line(scene, measured.references[s]);
        text += fmt::format("  {:<28} {:>12} {:>12} {:>12} {:>12}\n", "CPU seconds at error", "10 %", "3 %", "1 %",
                            "0.1 %");
        for (const PrecisionFront& front : fronts(measured.points, scene.name)) {
            text += fmt::format("  {:<28}", front.method);
            for (double error : {0.1, 0.03, 0.01, 0.001}) {
                const auto time = time_for_error(front, error);
                text += time ? fmt::format(" {:>12.4g}", *time) : fmt::format(" {:>12}", "-");
            }
            text += '\n';
        }
        text += verdict_sentence(fronts(measured.points, scene.name), scene.name, measured.standards[s]) + "\n\n";
    }
    return text;
}

}  // namespace

void bench_work_precision(bool json, const std::vector<std::string>& arguments, std::ostream& out)
{
    auto options = read_options("bench work-precision", arguments, {"--scene", "--output", "--quick"},
                                "--scene NAME, --output FOLDER or --quick 1");
    const std::string folder = options.count("--output") ? options["--output"] : "bench-out";
    const bool quick = options.count("--quick") && read_number("--quick", options["--quick"], 0, 1, "0 or 1") == 1;
    Measured measured;
    std::filesystem::create_directories(folder);
    for (const PrecisionScene& scene : precision_scenes(options["--scene"])) {
        measure_scene(scene, quick, measured);
        // The files are rewritten after each scene, so that stopping the suite keeps the scenes that are done.
        write_file_atomically(folder + "/work_precision.json", json_report(measured).dump(2) + "\n");
        write_file_atomically(folder + "/work_precision.csv", csv_text(measured.points));
        write_png(folder + "/work_precision.png", diagram(measured));
    }
    out << (json ? json_report(measured).dump(2) + "\n" : table(measured));
    if (!json) out << folder << "/work_precision.png\n";
}

}  // namespace selvage
