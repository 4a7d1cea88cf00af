#include "bench/suites/garment_rows.hpp"

#include <algorithm>
#include <filesystem>
#include <sstream>

#include "io/atomic_file.hpp"
#include "io/errors.hpp"
#include "io/file_text.hpp"

namespace selvage {
namespace {

namespace fs = std::filesystem;

std::string trimmed(const std::string& text)
{
    const auto first = text.find_first_not_of(" \t\r"), last = text.find_last_not_of(" \t\r");
    return first == std::string::npos ? "" : text.substr(first, last - first + 1);
}

std::string last_line(const std::string& text)
{
    const std::string all = text.substr(0, text.find_last_not_of("\n ") + 1);
    return all.substr(all.rfind('\n') + 1);
}

// A text of JSON is one of TOML as well.
std::string quoted(const std::string& text) { return nlohmann::json(text).dump(); }

double number_at(const nlohmann::json& summary, const char* pointer, double otherwise)
{
    const nlohmann::json::json_pointer at(pointer);
    return summary.contains(at) && summary.at(at).is_number() ? summary.at(at).get<double>() : otherwise;
}

}  // namespace

std::string GarmentRow::name() const
{
    return fs::path(pattern).stem().string() + "@" + fs::path(body).stem().string();
}

std::vector<GarmentRow> read_manifest(const std::string& file)
{
    std::istringstream lines(read_file_text(file, "a manifest: a pattern and a body a line"));
    std::vector<GarmentRow> rows;
    std::string line;
    for (int number = 1; std::getline(lines, line); ++number) {
        if (trimmed(line).empty() || trimmed(line).front() == '#') continue;
        const std::size_t tab = line.find('\t');
        const std::string pattern = trimmed(line.substr(0, tab));
        const std::string rest = tab == std::string::npos ? "" : line.substr(tab + 1);
        const std::string body = trimmed(rest.substr(0, rest.find('\t')));
        const InputPlace place{file, number, 1, {}};
        if (pattern.empty() || body.empty())
            throw InputError(place, "`" + trimmed(line).substr(0, 60) + "`",
                             "the names of a pattern and a body, separated by a tab");
        const auto found = [&](const std::string& name) {
            const fs::path folder = fs::absolute(file).parent_path();
            for (const fs::path& path : {folder / name, folder.parent_path() / name})
                if (fs::exists(path)) return path.string();
            throw InputError(place, "no file `" + name + "`", "a file beside the manifest or in the folder above");
        };
        rows.push_back({found(pattern), found(body)});
    }
    return rows;
}

std::vector<GarmentRow> rows_of_folder(const std::string& folder, const std::vector<std::string>& bodies)
{
    std::vector<std::string> patterns;
    if (fs::is_directory(folder))
        for (const fs::directory_entry& entry : fs::directory_iterator(folder))
            if (entry.path().extension() == ".json") patterns.push_back(entry.path().string());
    if (patterns.empty()) throw InputError({folder, 0, 0, "--patterns"}, "no pattern", "a folder with *.json files");
    std::ranges::sort(patterns);
    std::vector<GarmentRow> rows;
    for (const std::string& pattern : patterns)
        for (const std::string& body : bodies)
            rows.push_back({fs::absolute(pattern).string(), fs::absolute(body).string()});
    return rows;
}

DressedRow dress(const GarmentRow& row, const GarmentOptions& options)
{
    const std::string folder = options.folder + "/" + row.name();
    fs::create_directories(folder);
    const std::string scene = folder + "/scene.toml";
    write_file_atomically(scene, "[garment]\npattern = " + quoted(row.pattern) + "\nresolution = " +
                                     options.resolution + "\n[[body]]\nmesh = " + quoted(row.body) + "\nup_axis = \"" +
                                     options.up_axis + "\"\n[solver]\nmax_wall = " + options.limit + "\n");
    std::vector<std::string> arguments = {scene};
    for (const std::string& assignment : options.assignments)
        for (const std::string& word : {std::string("--set"), assignment}) arguments.push_back(word);
    const ChildRun run = run_child(own_program(), arguments, folder);
    DressedRow result;
    result.row = row;
    result.wall_s = run.wall_s;
    const nlohmann::json& s = run.summary;
    result.status = s.is_object() ? s.value("status", "none") : "exit " + std::to_string(run.exit_code);
    result.vertices = int(number_at(s, "/vertices", 0));
    result.self = int(number_at(s, "/self/intersections", -1));
    result.body = int(number_at(s, "/body/intersections", -1));
    result.penetration = number_at(s, "/body/max_penetration_m", 0);
    result.gap = number_at(s, "/seams/max_gap_m", -1);
    result.stretch = number_at(s, "/stretch/p99", 0);
    constexpr double joined = 1e-3;  // [m]
    result.good = run.finished() && result.status == "converged" && result.self == 0 && result.body == 0 &&
                  result.penetration == 0 && result.gap >= 0 && result.gap <= joined;
    if (!result.good) result.message = last_line(run.errors);
    if (fs::exists(folder + "/preview.png")) result.picture = folder + "/preview.png";
    return result;
}

}  // namespace selvage
