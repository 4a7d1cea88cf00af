#include "host/body/body_report.hpp"

#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "io/utf8.hpp"

namespace selvage {
namespace {

using Json = nlohmann::ordered_json;

// The direction in which the body looks, in the axes of the mesh.
Vec3 front_of(const BodyMeasures& measures)
{
    return measures.frame.to_file(-Vec3::UnitY()) - measures.frame.to_file(Vec3::Zero());
}

std::vector<std::pair<std::string, int>> counted_regions(const BodyMeasures& measures)
{
    std::vector<std::pair<std::string, int>> counted;
    for (const std::string_view word : words_of<BodyRegion>()) counted.emplace_back(word, 0);
    for (const BodyRegion region : measures.regions) ++counted[std::size_t(region)].second;
    std::erase_if(counted, [](const auto& entry) { return entry.second == 0; });
    return counted;
}

std::string table(const char* title, const std::vector<BodyMeasure>& measures)
{
    std::string text = fmt::format("\n{}\n", title);
    for (const BodyMeasure& measure : measures)
        text += fmt::format("  {:<20}{:>7.1f}  {}\n", measure.name, 100 * measure.value, measure.where);
    return text;
}

Json by_name(const std::vector<BodyMeasure>& measures)
{
    Json json = Json::object();
    for (const BodyMeasure& measure : measures) json[measure.name] = measure.value;
    return json;
}

}  // namespace

std::string measures_text(const BodyMeasures& measures, const std::string& name)
{
    const Vec3 front = front_of(measures);
    std::string text = fmt::format("{}: {:.1f} cm high, faces ({:.2f}, {:.2f})\n", printable(name),
                                   100 * measures.height, front.x(), front.y());
    if (measures.area_share < 1)
        text += fmt::format("  loose pieces with {:.1f} % of the area are left out\n", 100 * (1 - measures.area_share));
    if (measures.open_edges > 0)
        text += fmt::format("  edges of holes {:.1f} cm long in all are spanned\n", 100 * measures.open_edges);
    text += table("girths in cm (those of limbs: mean of both sides)", measures.girths);
    text += table("lengths in cm", measures.lengths);
    text += "\nlandmarks in cm, as in the mesh, z up\n";
    for (const Landmark& landmark : measures.landmarks) {
        const Vec3 at = 100 * landmark.position;
        text += fmt::format("  {:<20}{:>7.1f} {:>7.1f} {:>7.1f}\n", landmark.name, at.x(), at.y(), at.z());
    }
    text += "\nvertices\n";
    for (const auto& [region, count] : counted_regions(measures)) text += fmt::format("  {:<20}{:>7}\n", region, count);
    for (const std::string& missing : measures.missing) text += fmt::format("not found: {}\n", missing);
    return text;
}

std::string measures_json(const BodyMeasures& measures, const std::string& name)
{
    const Vec3 front = front_of(measures);
    Json json{{"body", name}, {"height_m", measures.height}, {"front", {front.x(), front.y(), front.z()}}};
    json["girths_m"] = by_name(measures.girths);
    json["lengths_m"] = by_name(measures.lengths);
    json["measured"] = Json::object();
    for (const auto* list : {&measures.girths, &measures.lengths})
        for (const BodyMeasure& measure : *list) json["measured"][measure.name] = measure.where;
    json["missing"] = measures.missing;
    json["landmarks"] = Json::object();
    for (const Landmark& landmark : measures.landmarks)
        json["landmarks"][landmark.name] = {landmark.position.x(), landmark.position.y(), landmark.position.z()};
    json["limbs"] = Json::object();
    for (const LimbLine& limb : measures.limbs) {
        Json& line = json["limbs"][limb.name] = Json::array();
        for (const LimbSection& section : limb.sections)
            line.push_back(
                {{"middle", {section.middle.x(), section.middle.y(), section.middle.z()}}, {"girth_m", section.girth}});
    }
    json["part_vertices"] = Json::object();
    for (const auto& [region, count] : counted_regions(measures)) json["part_vertices"][region] = count;
    json["loose_area_share"] = 1 - measures.area_share;
    json["open_edges_m"] = measures.open_edges;
    json["parts"] = Json::array();
    for (const BodyRegion region : measures.regions) json["parts"].push_back(word_of(region));
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace selvage
