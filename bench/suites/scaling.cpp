#include "bench/suites/scaling.hpp"

#include <cmath>
#include <filesystem>
#include <iostream>
#include <thread>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "bench/harness/chart.hpp"
#include "bench/harness/child_run.hpp"
#include "bench/harness/machine.hpp"
#include "bench/harness/options.hpp"
#include "io/atomic_file.hpp"

namespace selvage {
namespace {

using Json = nlohmann::ordered_json;

struct ScalingScene {
    std::string name, builtin, until;
    /// Returns the scene override that gives approximately this number of vertices.
    std::string (*resolution)(int vertices);
};

// The t-shirt has 12 168 vertices at an edge length of 1 cm, and the number of vertices is inversely proportional to
// the square of the edge length.
std::string garment_resolution(int vertices)
{
    return fmt::format("garment.resolution={:.6g}", 0.01 * std::sqrt(12168.0 / vertices));
}

std::string sheet_resolution(int vertices)
{
    return fmt::format("sheet.resolution={}", std::lround(std::sqrt(double(vertices))));
}

// The scene has eight layers, like a cloth that has been folded three times.
std::string layer_resolution(int vertices) { return sheet_resolution(vertices / 8); }

const std::vector<ScalingScene>& scaling_scenes()
{
    static const std::vector<ScalingScene> all = {{"hanging", "hanging", "equilibrium", sheet_resolution},
                                                  {"sphere", "sphere", "0.5", sheet_resolution},
                                                  {"layers", "stress_stack", "0.2", layer_resolution},
                                                  {"tshirt", "tshirt", "equilibrium", garment_resolution}};
    return all;
}

struct ScalingOptions {
    std::string scene, until, output = "bench-out", program = own_program();
    int min_vertices = 4225, max_vertices = 70000;
    std::vector<int> threads;
    double max_seconds = 600;
};

struct ScalingPoint {
    std::string scene, until;
    int threads = 1;
    ChildRun run;
    double number(const char* key) const
    {
        return run.summary.is_null() || run.summary[key].is_null() ? 0 : run.summary[key].get<double>();
    }
    double vertices() const { return number("vertices"); }
    double step_s() const { return number("steps") > 0 ? number("wall_s") / number("steps") : 0; }
    double contact_share() const;  ///< Share of the time of all phases [1].
};

// Contact is the broad phase, the CCD step filter, body queries and the terms of contact and friction.
double ScalingPoint::contact_share() const
{
    double all = 0, contact = 0;
    for (std::size_t k = 0; k < run.phases.size(); ++k) {
        const std::string name = run.phases[k].substr(run.phases[k].rfind('/') + 1);
        const bool meets = name.find("contact") != std::string::npos || name.find("friction") != std::string::npos ||
                           name.find("repulsion") != std::string::npos || name == "body_query" ||
                           name == "advance_held" || name == "cloth_tree" || name == "look_around";
        all += run.self_s[k];
        contact += meets ? run.self_s[k] : 0;
    }
    return all > 0 ? contact / all : 0;
}

// A quantity that is plotted and whose growth exponent is fitted.
struct Quantity {
    const char *name, *label;
    double (*of)(const ScalingPoint&);
};

constexpr Quantity quantities[] = {
    {"wall_s", "wall time [s]", [](const ScalingPoint& p) { return p.number("wall_s"); }},
    {"step_s", "time per step [s]", [](const ScalingPoint& p) { return p.step_s(); }},
    {"peak_memory_bytes", "peak memory [MiB]",
     [](const ScalingPoint& p) { return p.run.peak_memory_bytes / (1 << 20); }},
    {"newton_iterations", "Newton iterations", [](const ScalingPoint& p) { return p.number("newton_iterations"); }},
    {"linear_iterations", "linear iterations", [](const ScalingPoint& p) { return p.number("linear_iterations"); }},
    {"contacts", "vertices in contact", [](const ScalingPoint& p) { return double(p.run.contacts); }},
};

std::string series_name(const ScalingPoint& point)
{
    return fmt::format("{}, {} thread{}", point.scene, point.threads, point.threads == 1 ? "" : "s");
}

std::vector<std::string> series_names(const std::vector<ScalingPoint>& points)
{
    std::vector<std::string> names;
    for (const ScalingPoint& point : points)
        if (std::find(names.begin(), names.end(), series_name(point)) == names.end())
            names.push_back(series_name(point));
    return names;
}

// One series of the runs that finished. Zeros are left out, since they have no logarithm.
ChartSeries series_of(const std::vector<ScalingPoint>& points, const std::string& name, const Quantity& quantity)
{
    ChartSeries series{name, {}, {}};
    for (const ScalingPoint& point : points) {
        if (series_name(point) != name || !point.run.finished() || !(quantity.of(point) > 0)) continue;
        series.x.push_back(point.vertices());
        series.y.push_back(quantity.of(point));
    }
    return series;
}

ScalingOptions read_scaling_options(const std::vector<std::string>& arguments)
{
    auto given =
        read_options("bench scaling", arguments,
                     {"--scene", "--min-vertices", "--max-vertices", "--threads", "--until", "--max-seconds",
                      "--output", "--program"},
                     "--scene NAME, --min-vertices N, --max-vertices N, --threads N, --until equilibrium|SECONDS, "
                     "--max-seconds S, --output FOLDER or --program FILE");
    ScalingOptions options;
    std::vector<std::string> names;
    for (const ScalingScene& scene : scaling_scenes()) names.push_back(scene.name);
    for (const auto& [name, value] : given) {
        if (name == "--scene") options.scene = value;
        if (name == "--until") options.until = value;
        if (name == "--output") options.output = value;
        if (name == "--program") options.program = value;
        if (name == "--min-vertices")
            options.min_vertices = read_number(name, value, 100, 20'000'000, "vertices from 100 to 2e7");
        if (name == "--max-vertices")
            options.max_vertices = read_number(name, value, 100, 20'000'000, "vertices from 100 to 2e7");
        if (name == "--threads") options.threads = {read_number(name, value, 1, 1024, "threads from 1 to 1024")};
        if (name == "--max-seconds") options.max_seconds = read_number(name, value, 1.0, 1e6, "seconds from 1 to 1e6");
    }
    if (!options.scene.empty() && std::find(names.begin(), names.end(), options.scene) == names.end())
        throw InputError({"", 0, 0, "--scene"}, "`" + options.scene + "`", "hanging, sphere, layers or tshirt",
                         nearest_name(options.scene, names));
    if (options.max_vertices < options.min_vertices)
        throw InputError({"", 0, 0, "--max-vertices"}, std::to_string(options.max_vertices),
                         "at least --min-vertices, " + std::to_string(options.min_vertices));
    const int all = std::max(1, int(std::thread::hardware_concurrency()));
    if (options.threads.empty()) options.threads = all == 1 ? std::vector<int>{1} : std::vector<int>{1, all};
    return options;
}

ScalingPoint measure(const ScalingOptions& options, const ScalingScene& scene, int vertices, int threads)
{
    const std::string until = options.until.empty() ? scene.until : options.until;
    const std::vector<std::string> arguments = {"builtin:" + scene.builtin,
                                                "--profile",
                                                "--threads",
                                                std::to_string(threads),
                                                "--set",
                                                scene.resolution(vertices),
                                                "--set",
                                                "solver.until=" + (until == "equilibrium" ? "\"equilibrium\"" : until),
                                                "--set",
                                                fmt::format("solver.max_wall={:g}", options.max_seconds),
                                                "--set",
                                                "output.picture=false",
                                                "--set",
                                                "output.frames=false",
                                                "--set",
                                                "output.sewing=false"};
    ScalingPoint point{scene.name, until, threads, run_child(options.program, arguments)};
    std::cerr << fmt::format("{}: {:.0f} vertices, {} threads, {:.1f} s, exit code {}\n", scene.name, point.vertices(),
                             threads, point.run.wall_s, point.run.exit_code);
    if (!point.run.finished()) std::cerr << point.run.errors;
    return point;
}

std::string csv_text(const std::vector<ScalingPoint>& points)
{
    std::string text =
        "scene,until,threads,vertices,wall_s,process_s,cpu_s,peak_memory_bytes,newton_iterations,"
        "linear_iterations,contacts,residual,exit_code,step_s,contact_share\n";
    for (const ScalingPoint& p : points)
        text += fmt::format("{},{},{},{:.0f},{:.6g},{:.6g},{:.6g},{:.0f},{:.0f},{:.0f},{},{:.4g},{},{:.4g},{:.3f}\n",
                            p.scene, p.until, p.threads, p.vertices(), p.number("wall_s"), p.run.wall_s, p.run.cpu_s,
                            p.run.peak_memory_bytes, p.number("newton_iterations"), p.number("linear_iterations"),
                            p.run.contacts, p.number("residual"), p.run.exit_code, p.step_s(), p.contact_share());
    return text;
}

Json json_report(const std::vector<ScalingPoint>& points)
{
    Json report;
    report["context"] = bench_context(int(std::thread::hardware_concurrency()));
    for (const std::string& name : series_names(points))
        for (const Quantity& quantity : quantities) {
            const ChartSeries series = series_of(points, name, quantity);
            const auto exponent = growth_exponent(series.x, series.y);
            report["context"]["growth_exponents"][name][quantity.name] = exponent ? Json(*exponent) : Json();
        }
    report["benchmarks"] = Json::array();
    for (const ScalingPoint& p : points) {
        Json run = timed_run(fmt::format("{}/vertices:{:.0f}/threads:{}", p.scene, p.vertices(), p.threads),
                             p.run.wall_s, p.run.cpu_s);
        run["threads"] = p.threads;
        run["until"] = p.until;
        run["vertices"] = p.vertices();
        for (const Quantity& quantity : quantities) run[quantity.name] = quantity.of(p);
        run["peak_memory_bytes"] = p.run.peak_memory_bytes;
        run["contact_share"] = p.contact_share();
        run["residual"] = p.number("residual");
        run["finished"] = p.run.finished();
        report["benchmarks"].push_back(std::move(run));
    }
    return report;
}

Image diagram(const std::vector<ScalingPoint>& points)
{
    const std::vector<std::string> names = series_names(points);
    std::vector<Image> charts;
    for (const Quantity& quantity : quantities) {
        LogChart chart{quantity.label, "vertices", quantity.label, {}, 0, ""};
        for (const std::string& name : names) {
            ChartSeries series = series_of(points, name, quantity);
            if (!series.x.empty()) chart.series.push_back(std::move(series));
        }
        if (!chart.series.empty()) charts.push_back(draw_log_chart(chart, names, 760, 460));
    }
    return tile(charts, std::min(2, int(charts.size())));
}

std::string table(const std::vector<ScalingPoint>& points)
{
    std::string text = fmt::format("{:<10} {:>8} {:>10} {:>10} {:>12} {:>8} {:>8} {:>9} {:>10} {:>9} {:>8}\n", "scene",
                                   "threads", "vertices", "wall s", "memory MiB", "Newton", "linear", "contacts",
                                   "residual", "ms/step", "contact");
    for (const ScalingPoint& p : points)
        text += fmt::format(
            "{:<10} {:>8} {:>10.0f} {:>10.2f} {:>12.1f} {:>8.0f} {:>8.0f} {:>9} {:>10.2e} {:>9.1f} {:>7.0f}%{}\n",
            p.scene, p.threads, p.vertices(), p.number("wall_s"), p.run.peak_memory_bytes / (1 << 20),
            p.number("newton_iterations"), p.number("linear_iterations"), p.run.contacts, p.number("residual"),
            1e3 * p.step_s(), 100 * p.contact_share(),
            p.run.finished() ? "" : fmt::format("  not finished (exit code {})", p.run.exit_code));
    text +=
        "contact: share of the time of all phases in finding contacts, clearing ways, and forces of contact and "
        "friction\n"
        "\ngrowth exponents against vertices\n";
    for (const std::string& name : series_names(points)) {
        text += fmt::format("{:<24}", name);
        for (const Quantity& quantity : quantities) {
            const ChartSeries series = series_of(points, name, quantity);
            const auto exponent = growth_exponent(series.x, series.y);
            text += exponent ? fmt::format("  {} {:.2f}", quantity.name, *exponent) : "";
        }
        text += '\n';
    }
    return text;
}

}  // namespace

std::optional<double> growth_exponent(const std::vector<double>& x, const std::vector<double>& y)
{
    double mean_x = 0, mean_y = 0, xx = 0, xy = 0;
    for (std::size_t i = 0; i < x.size(); ++i) {
        mean_x += std::log(x[i]) / double(x.size());
        mean_y += std::log(y[i]) / double(x.size());
    }
    for (std::size_t i = 0; i < x.size(); ++i) {
        xx += std::pow(std::log(x[i]) - mean_x, 2);
        xy += (std::log(x[i]) - mean_x) * (std::log(y[i]) - mean_y);
    }
    if (!(xx > 1e-12)) return {};
    return xy / xx;
}

void bench_scaling(bool json, const std::vector<std::string>& arguments, std::ostream& out)
{
    const ScalingOptions options = read_scaling_options(arguments);
    std::filesystem::create_directories(options.output);
    std::vector<ScalingPoint> points;
    for (const ScalingScene& scene : scaling_scenes()) {
        if (!options.scene.empty() && scene.name != options.scene) continue;
        // Each size has four times as many vertices as the one before, that is, half the edge length.
        for (double vertices = options.min_vertices; vertices <= 1.05 * options.max_vertices; vertices *= 4)
            for (int threads : options.threads) {
                points.push_back(measure(options, scene, int(vertices), threads));
                // The files are rewritten after each run, so that stopping the suite keeps the runs that are done.
                write_file_atomically(options.output + "/scaling.csv", csv_text(points));
                write_file_atomically(options.output + "/scaling.json", json_report(points).dump(2) + "\n");
                if (points.back().run.finished()) write_png(options.output + "/scaling.png", diagram(points));
            }
    }
    out << (json ? json_report(points).dump(2) + "\n" : table(points));
    if (!json) out << options.output << "/scaling.png\n";
}

}  // namespace selvage
