#include "bench/suites/garments.hpp"

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <sstream>

#include <fmt/format.h>
#include <tbb/task_arena.h>
#include <nlohmann/json.hpp>

#include "bench/harness/chart.hpp"
#include "bench/harness/machine.hpp"
#include "bench/harness/options.hpp"
#include "bench/suites/garment_rows.hpp"
#include "io/atomic_file.hpp"
#include "io/errors.hpp"
#include "io/image.hpp"

namespace selvage {
namespace {

using Json = nlohmann::ordered_json;

constexpr int sheet_columns = 6, field_width = 300, field_height = 250;  // of the contact sheet [pixels]

std::vector<std::string> split(const std::string& list)
{
    std::vector<std::string> words;
    std::istringstream stream(list);
    for (std::string word; std::getline(stream, word, ',');)
        if (!word.empty()) words.push_back(word);
    return words;
}

std::vector<GarmentRow> chosen_rows(std::map<std::string, std::string>& options)
{
    const bool by_manifest = options.count("--manifest"), by_folder = options.count("--patterns");
    if (by_manifest == by_folder)
        throw InputError({"", 0, 0, "bench garments"}, by_manifest ? "both" : "neither of them",
                         "--manifest FILE, or --patterns FOLDER with --body FILE[,FILE]");
    if (by_folder != (options.count("--body") > 0))
        throw InputError({"", 0, 0, "--body"}, by_folder ? "none" : "bodies beside a manifest, which names its own",
                         "--body with --patterns only");
    std::vector<GarmentRow> rows = by_manifest ? read_manifest(options["--manifest"])
                                               : rows_of_folder(options["--patterns"], split(options["--body"]));
    const std::vector<std::string> words = split(options["--only"]);
    std::erase_if(rows, [&](const GarmentRow& row) {
        return !words.empty() && std::none_of(words.begin(), words.end(), [&](const std::string& word) {
            return row.name().find(word) != std::string::npos;
        });
    });
    if (rows.empty())
        throw InputError({"", 0, 0, "--only"}, "`" + options["--only"] + "`", "a word that a row's name has");
    return rows;
}

GarmentOptions garment_options(std::map<std::string, std::string>& given)
{
    GarmentOptions options;
    for (const auto& [name, target, high] :
         {std::tuple{"--resolution", &options.resolution, 1.0}, std::tuple{"--limit", &options.limit, 1e6}}) {
        if (!given.count(name)) continue;
        *target = given[name];
        read_number(name, *target, 1e-4, high, fmt::format("a number up to {:g}", high));
    }
    if (given.count("--up")) options.up_axis = given["--up"];
    options.assignments = split(given["--set"]);
    options.folder = given.count("--output") ? given["--output"] : "bench-out";
    return options;
}

std::string heading()
{
    return fmt::format("{:<44} {:>12} {:>7} {:>8} {:>6} {:>5} {:>8} {:>7} {:>6}\n", "garment", "status", "wall s",
                       "vertices", "self", "body", "depth mm", "gap mm", "p99 %");
}

std::string line_of(const DressedRow& r)
{
    return fmt::format("{:<44} {:>12} {:>7.1f} {:>8} {:>6} {:>5} {:>8.2f} {:>7.1f} {:>6.1f}{}\n", r.row.name(),
                       r.status, r.wall_s, r.vertices, r.self, r.body, 1000 * r.penetration, 1000 * r.gap,
                       100 * r.stretch, r.good ? "" : "  " + r.message.substr(0, 110));
}

std::string last_line(const std::vector<DressedRow>& rows)
{
    std::vector<double> walls;
    for (const DressedRow& row : rows) walls.push_back(row.wall_s);
    std::ranges::sort(walls);
    return fmt::format("{} of {} good; wall median {:.1f} s, slowest {:.1f} s\n",
                       std::ranges::count(rows, true, &DressedRow::good), rows.size(), walls[walls.size() / 2],
                       walls.back());
}

Json json_report(const std::vector<DressedRow>& rows)
{
    Json report;
    report["context"] = bench_context(tbb::this_task_arena::max_concurrency());
    report["benchmarks"] = Json::array();
    for (const DressedRow& r : rows) {
        Json run = timed_run(r.row.name(), r.wall_s, r.wall_s);
        run["good"] = r.good;
        run["status"] = r.status;
        run["vertices"] = r.vertices;
        run["self_intersections"] = r.self;
        run["body_intersections"] = r.body;
        run["max_penetration_m"] = r.penetration;
        run["max_gap_m"] = r.gap;
        run["stretch_p99"] = r.stretch;
        if (!r.message.empty()) run["message"] = r.message;
        report["benchmarks"].push_back(std::move(run));
    }
    return report;
}

Image contact_sheet(const std::vector<DressedRow>& rows)
{
    std::vector<Image> fields;
    for (const DressedRow& r : rows)
        fields.push_back(captioned(r.picture.empty() ? Image{} : read_image(r.picture),
                                   fmt::format("{}  {}", r.row.name(), r.good ? "good" : r.status), field_width,
                                   field_height));
    return tile(fields, std::min(sheet_columns, int(fields.size())));
}

}  // namespace

void bench_garments(bool json, const std::vector<std::string>& arguments, std::ostream& out)
{
    auto given = read_options(
        "bench garments", arguments,
        {"--manifest", "--patterns", "--body", "--only", "--resolution", "--limit", "--up", "--set", "--output"},
        "--manifest FILE, or --patterns FOLDER with --body FILE[,FILE]; --only WORD[,WORD], "
        "--resolution M, --limit SECONDS, --up AXIS, --set KEY=VALUE[,KEY=VALUE], "
        "--output FOLDER");
    const std::vector<GarmentRow> rows = chosen_rows(given);
    const GarmentOptions options = garment_options(given);
    std::filesystem::create_directories(options.folder);
    if (!json) out << heading() << std::flush;
    std::vector<DressedRow> dressed;
    for (const GarmentRow& row : rows) {
        dressed.push_back(dress(row, options));
        if (!json) out << line_of(dressed.back()) << std::flush;
        // Written again after each row, so that stopping the suite keeps those that are done.
        write_file_atomically(options.folder + "/garments.json", json_report(dressed).dump(2) + "\n");
        write_png(options.folder + "/garments.png", contact_sheet(dressed));
    }
    if (json) {
        out << json_report(dressed).dump(2) + "\n";
    } else {
        out << last_line(dressed) << options.folder << "/garments.png\n";
    }
}

}  // namespace selvage
