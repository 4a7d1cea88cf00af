#include "io/run/describe.hpp"

#include <filesystem>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "io/run/trajectory.hpp"
#include "io/steady_read.hpp"
#include "io/utf8.hpp"

namespace selvage {
namespace {

using Json = nlohmann::ordered_json;

Json contents(const std::string& path)
{
    const TrajectoryReader run = read_steadily(path, [&] { return TrajectoryReader(path); });
    const TrajectoryLayout& layout = run.layout();
    const bool empty = run.frame_count() == 0;
    Json json;
    json["file"] = path;
    json["kind"] = "run";
    json["version"] = layout.version;
    json["frames"] = run.frame_count();
    json["points"] = layout.point_count;
    json["triangles"] = layout.triangles.size();
    json["seam_pairs"] = layout.seam_pairs.size();
    json["panels"] = layout.panel_names;
    json["first_time_s"] = empty ? Json(nullptr) : Json(run.scalars(0).time);
    json["last_time_s"] = empty ? Json(nullptr) : Json(run.scalars(run.frame_count() - 1).time);
    json["position_grid_m"] = grid_spacing(layout.grid);
    json["bytes"] = std::filesystem::file_size(path);
    return json;
}

std::string joined(const Json& names)
{
    std::string text;
    for (const Json& name : names) text += (text.empty() ? "" : ", ") + name.get<std::string>();
    return text.empty() ? "-" : printable(text);
}

}  // namespace

std::string describe_run(const std::string& path, bool json)
{
    const Json held = contents(path);
    if (json) return held.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
    const int frame_count = held["frames"];
    const double grid = held["position_grid_m"];
    std::string text = fmt::format("{}: run written by selvage {}, {:.2f} MB\n", printable(path),
                                   printable(held["version"].get<std::string>()), held["bytes"].get<double>() / 1e6);
    text += fmt::format("frames     {}", frame_count);
    if (frame_count > 0)
        text += fmt::format(", {:.4g} s to {:.4g} s", held["first_time_s"].get<double>(),
                            held["last_time_s"].get<double>());
    text += fmt::format("\npoints     {}\ntriangles  {}\nseam pairs {}\npanels     {}\n", held["points"].get<int>(),
                        held["triangles"].get<int>(), held["seam_pairs"].get<int>(), joined(held["panels"]));
    text +=
        grid > 0 ? fmt::format("positions  rounded to {:.3g} m\n", grid) : "positions  single precision, not rounded\n";
    return text;
}

}  // namespace selvage
