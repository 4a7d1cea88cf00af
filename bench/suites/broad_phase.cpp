#include "bench/suites/broad_phase.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
#include <functional>
#include <iostream>
#include <limits>
#include <memory>
#include <numbers>
#include <stdexcept>
#include <thread>

#include <fmt/format.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>
#include <nlohmann/json.hpp>

#include "bench/harness/machine.hpp"
#include "bench/harness/options.hpp"
#include "bench/suites/embree_pairs.hpp"
#include "host/collision/ccd.hpp"
#include "host/garment/sheet.hpp"
#include "host/solver/contact/cloth_surface.hpp"
#include "host/solver/contact/contact_tuning.hpp"

namespace selvage {
namespace {

using Json = nlohmann::ordered_json;
using Positions = std::vector<double>;  // component planes

constexpr double gap = 0.001;  // [m]

struct BroadPhaseOptions {
    std::vector<int> sides{66, 129};
    int repeats = 7, looks = 8;
};

// Of the fastest repeat.
struct Spent {
    double wall_s = std::numeric_limits<double>::infinity(), cpu_s = wall_s;

    void time(const std::function<void()>& work)
    {
        const auto cpu = [] {
            timespec t{};
            clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
            return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
        };
        const auto begin = std::chrono::steady_clock::now();
        const double cpu_before = cpu();
        work();
        cpu_s = std::min(cpu_s, cpu() - cpu_before);
        wall_s = std::min(wall_s, std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
    }
};

struct BroadPhaseResult {
    std::string shape, method;
    int side = 0;
    Spent build, find, step;  // find: with the update of boxes before; step: several looks
    std::size_t candidates = 0, pairs = 0;
};

// A sheet of one metre in some shape, and the same a little later.
struct Shape {
    std::string name;
    std::function<Vec3(const Vec2&)> at;
};

std::vector<Shape> shapes()
{
    constexpr double pi = std::numbers::pi, layer = 0.125, apart = 0.0006;
    return {
        {"hanging",
         [](const Vec2& u) { return Vec3(u.x(), 0.01 * std::sin(pi * u.x()) * std::cos(2 * pi * u.y()), u.y()); }},
        // Eight layers, one on the other.
        {"folded",
         [](const Vec2& u) {
             const double count = std::floor((u.x() + 0.5) / layer), along = u.x() + 0.5 - count * layer;
             return Vec3(std::fmod(count, 2) == 0 ? along : layer - along, u.y(), apart * count);
         }},
        {"crumpled",
         [](const Vec2& u) {
             Vec3 x(0.5 * u.x(), 0.5 * u.y(), 0);
             for (int wave = 1; wave <= 6; ++wave) {
                 const double angle = 2.399963 * wave,
                              phase = 3 * pi * wave * (u.x() * std::cos(angle) + u.y() * std::sin(angle));
                 x += 0.1 / wave * Vec3(std::sin(phase), std::cos(1.3 * phase), std::sin(0.7 * phase + wave));
             }
             return x;
         }},
    };
}

std::vector<int> read_sides(const std::string& text)
{
    std::vector<int> sides;
    for (std::size_t begin = 0; begin <= text.size();) {
        const std::size_t comma = std::min(text.find(',', begin), text.size());
        sides.push_back(read_number("--sides", text.substr(begin, comma - begin), 3, 1025,
                                    "vertices a side from 3 to 1025, separated by commas"));
        begin = comma + 1;
    }
    return sides;
}

BroadPhaseOptions read_broad_phase_options(const std::vector<std::string>& arguments)
{
    BroadPhaseOptions options;
    for (const auto& [name, value] : read_options("bench broad-phase", arguments, {"--sides", "--repeats", "--looks"},
                                                  "--sides N[,N...], --repeats N or --looks N")) {
        if (name == "--sides") options.sides = read_sides(value);
        if (name == "--looks") options.looks = read_number(name, value, 1, 1000, "a number from 1 to 1000");
        if (name == "--repeats") options.repeats = read_number(name, value, 1, 1000, "a number from 1 to 1000");
    }
    return options;
}

struct Sheet {
    Cloth cloth;
    TreeSurface surface;
    int stride = 0;
    Positions now, later;

    Sheet(const Shape& shape, int side)
    {
        SheetScene scene;
        scene.resolution = side;
        cloth = make_sheet(scene, "", "sheet[0]");
        surface = tree_surface(make_topology(cloth, true), cloth);
        const int count = int(cloth.positions.size());
        stride = padded_stride(count);
        now.resize(3 * std::size_t(stride));
        later = now;
        for (int v = 0; v < count; ++v) {
            const Vec2& u = cloth.panel_coordinates[v];
            const Vec3 x = shape.at(u);
            for (int c = 0; c < 3; ++c) {
                now[c * std::size_t(stride) + v] = x[c];
                later[c * std::size_t(stride) + v] = x[c] + 0.1 * gap * std::sin(20 * u.x() + 13 * u.y() + c);
            }
        }
    }
};

// The candidates that are within the gap, each named the same way whoever found it.
std::vector<std::array<int, 5>> close_pairs(const std::vector<PairCandidate>& candidates, const Positions& pos,
                                            int stride)
{
    std::vector<std::array<int, 5>> keys(candidates.size());
    tbb::parallel_for(std::size_t(0), candidates.size(), [&](std::size_t k) {
        PairCandidate c = candidates[k];
        PairCorners x;
        for (int i = 0; i < 4; ++i)
            for (int d = 0; d < 3; ++d) x[i][d] = pos[d * std::size_t(stride) + c.corner[i]];
        keys[k][0] = -1;
        if (!(pair_distance(x, c.edges) < gap)) return;
        if (c.edges) {
            std::sort(c.corner.begin(), c.corner.begin() + 2);
            std::sort(c.corner.begin() + 2, c.corner.end());
            if (c.corner[2] < c.corner[0])
                std::swap_ranges(c.corner.begin(), c.corner.begin() + 2, c.corner.begin() + 2);
        } else {
            std::sort(c.corner.begin() + 1, c.corner.end());
        }
        keys[k] = {int(c.edges), c.corner[0], c.corner[1], c.corner[2], c.corner[3]};
    });
    std::erase_if(keys, [](const auto& key) { return key[0] < 0; });
    tbb::parallel_sort(keys.begin(), keys.end());
    return keys;
}

// Positions go to and fro between the two shapes, so that each look has something new to find. The
// tree searches anew in each step; within it candidates serve on where they are proved to be complete.
void measure_own(const Sheet& sheet, double slack, const BroadPhaseOptions& options, BroadPhaseResult& result,
                 std::vector<std::array<int, 5>>& pairs)
{
    const double edge = typical_edge(sheet.cloth);
    const std::vector<Vec3> no_bodies;
    std::unique_ptr<ClothTree> tree;
    const auto look = [&](const Positions& at) {
        tree->cover(at.data(), nullptr, sheet.stride, {no_bodies}, gap, gap);
    };
    for (int repeat = 0; repeat < options.repeats; ++repeat) {
        result.build.time([&] { tree = std::make_unique<ClothTree>(sheet.surface, slack * edge); });
        look(sheet.now);
        tree->forget();
        result.step.time([&] {
            for (int k = options.looks; k > 0; --k) look(k % 2 ? sheet.later : sheet.now);
        });
        tree->forget();
        result.find.time([&] { look(sheet.later); });
    }
    result.candidates = tree->candidates().size();
    pairs = close_pairs(tree->candidates(), sheet.later, sheet.stride);
    result.pairs = pairs.size();
}

void measure_embree(const Sheet& sheet, EmbreePairs::Update update, const BroadPhaseOptions& options,
                    BroadPhaseResult& result, std::vector<std::array<int, 5>>& pairs)
{
    const EmbreeDevice device;
    std::vector<PairCandidate> candidates;
    for (int repeat = 0; repeat < options.repeats; ++repeat) {
        EmbreePairs tree(device, sheet.surface, update);
        const auto look = [&](const Positions& at) {
            tree.move(at.data(), sheet.stride, gap);
            candidates = tree.candidates();
        };
        result.build.time([&] { tree.move(sheet.now.data(), sheet.stride, gap); });
        result.step.time([&] {
            for (int k = options.looks; k > 0; --k) look(k % 2 ? sheet.later : sheet.now);
        });
        look(sheet.now);
        result.find.time([&] { look(sheet.later); });
    }
    result.candidates = candidates.size();
    pairs = close_pairs(candidates, sheet.later, sheet.stride);
    result.pairs = pairs.size();
}

std::vector<BroadPhaseResult> measure(const Shape& shape, int side, const BroadPhaseOptions& options)
{
    const Sheet sheet(shape, side);
    std::vector<BroadPhaseResult> results;
    std::vector<std::array<int, 5>> first;
    const auto add = [&](const std::string& method, const auto& run) {
        BroadPhaseResult& result = results.emplace_back();
        result.shape = shape.name;
        result.method = method;
        result.side = side;
        std::vector<std::array<int, 5>> pairs;
        run(result, pairs);
        std::cerr << fmt::format("{} {} {}: {:.3f} ms\n", shape.name, side, method, 1e3 * result.find.wall_s);
        if (results.size() == 1) first = pairs;
        if (pairs != first)
            throw std::runtime_error(
                fmt::format("bench broad-phase: {} of {} finds {} pairs within the gap, {} finds {}, or others",
                            results[0].method, shape.name, first.size(), method, pairs.size()));
    };
    using Update = EmbreePairs::Update;
    add("embree refit", [&](auto& r, auto& p) { measure_embree(sheet, Update::refit, options, r, p); });
    add("embree rebuild", [&](auto& r, auto& p) { measure_embree(sheet, Update::rebuild, options, r, p); });
    add("own, no slack", [&](auto& r, auto& p) { measure_own(sheet, 0, options, r, p); });
    add("own", [&](auto& r, auto& p) { measure_own(sheet, ContactTuning::tree_slack, options, r, p); });
    return results;
}

const BroadPhaseResult& refit_of(const std::vector<BroadPhaseResult>& results, const BroadPhaseResult& result)
{
    return *std::find_if(results.begin(), results.end(), [&](const BroadPhaseResult& other) {
        return other.shape == result.shape && other.side == result.side;
    });
}

std::string table(const std::vector<BroadPhaseResult>& results)
{
    std::string text = fmt::format("{:<9} {:>6} {:<14} {:>9} {:>9} {:>9} {:>10} {:>9} {:>10} {:>11} {:>8}\n", "shape",
                                   "a side", "method", "build ms", "find ms", "cpu ms", "of Embree", "step ms",
                                   "of Embree", "candidates", "in gap");
    for (const BroadPhaseResult& r : results) {
        const BroadPhaseResult& rival = refit_of(results, r);
        text += fmt::format("{:<9} {:>6} {:<14} {:>9.3f} {:>9.3f} {:>9.3f} {:>9.1f}% {:>9.3f} {:>9.1f}% {:>11} {:>8}\n",
                            r.shape, r.side, r.method, 1e3 * r.build.wall_s, 1e3 * r.find.wall_s, 1e3 * r.find.cpu_s,
                            100 * r.find.cpu_s / rival.find.cpu_s, 1e3 * r.step.cpu_s,
                            100 * r.step.cpu_s / rival.step.cpu_s, r.candidates, r.pairs);
    }
    return text +
           "times: the least of all repeats; build: the first hierarchy, once a run; find: bring the boxes up to date "
           "and list "
           "the candidates, wall time and processor time of all threads; step: processor time of the looks of one time "
           "step, "
           "the first of which searches; of Embree: against Embree with its hierarchy refitted; no slack: boxes as "
           "tight as "
           "Embree's; own: as contact uses it; all methods find the same pairs within the gap\n";
}

Json json_report(const std::vector<BroadPhaseResult>& results)
{
    Json report;
    report["context"] = bench_context(int(std::thread::hardware_concurrency()));
    report["context"]["gap"] = gap;
    report["benchmarks"] = Json::array();
    for (const BroadPhaseResult& r : results) {
        Json run = timed_run(fmt::format("{}/side:{}/{}", r.shape, r.side, r.method), r.find.wall_s, r.find.cpu_s);
        run["build_time"] = r.build.wall_s;
        run["step_time"] = r.step.cpu_s;
        run["time_of_embree"] = r.find.cpu_s / refit_of(results, r).find.cpu_s;
        run["step_of_embree"] = r.step.cpu_s / refit_of(results, r).step.cpu_s;
        run["candidates"] = r.candidates;
        run["pairs"] = r.pairs;
        report["benchmarks"].push_back(std::move(run));
    }
    return report;
}

}  // namespace

void bench_broad_phase(bool json, const std::vector<std::string>& arguments, std::ostream& out)
{
    const BroadPhaseOptions options = read_broad_phase_options(arguments);
    std::vector<BroadPhaseResult> results;
    for (const Shape& shape : shapes())
        for (int side : options.sides) {
            const std::vector<BroadPhaseResult> of_shape = measure(shape, side, options);
            results.insert(results.end(), of_shape.begin(), of_shape.end());
        }
    out << (json ? json_report(results).dump(2) + "\n" : table(results));
}

}  // namespace selvage
