#include <cmath>
#include <iostream>
#include <memory>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "host/commands/commands.hpp"
#include "io/scene/fabric_table.hpp"
#include "io/scene/scene.hpp"

namespace selvage {
namespace {

struct Property {
    const char* name;
    const char* unit;
    double Fabric::*value;
};

// Names and units come from the list of scene keys, so that every property is listed without a change here.
#define PROPERTY(type, name, initial, unit, low, high, meaning) {#name, unit, &Fabric::name},
#define LIST_CURVE(name, number, measure, meaning) {#name, CurveMeasure::measure, &Fabric::name},
#define NOT_A_KEY(name, ...)
constexpr Property properties[] = {FABRIC_KEYS(PROPERTY, NOT_A_KEY, NOT_A_KEY, NOT_A_KEY)};
struct CurveProperty {
    const char* name;
    CurveMeasure measure;
    StressCurve Fabric::*curve;
};
constexpr CurveProperty curves[] = {FABRIC_KEYS(NOT_A_KEY, NOT_A_KEY, NOT_A_KEY, LIST_CURVE)};
#undef PROPERTY
#undef LIST_CURVE
#undef NOT_A_KEY

// Returns the ends of a curve's ranges as pairs of the measured quantities.
std::vector<Vec2> measured_ends(const StressCurve& curve, CurveMeasure measure)
{
    std::vector<Vec2> ends;
    for (const CurveRange& range : curve) ends.push_back(measured_point(measure, {range.start, range.stress}));
    return ends;
}

void print_json()
{
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (const std::string& name : fabric_preset_names()) {
        const Fabric fabric = fabric_preset(name);
        nlohmann::ordered_json entry{{"name", name}};
        for (const Property& property : properties) entry[property.name] = fabric.*property.value;
        for (const CurveProperty& property : curves) {
            if ((fabric.*property.curve).empty()) continue;
            for (const Vec2& point : measured_ends(fabric.*property.curve, property.measure))
                entry[property.name].push_back({point.x(), point.y()});
        }
        entry["source"] = fabric.source;
        list.push_back(entry);
    }
    std::cout << list.dump(2) << '\n';
}

void print_curve(const StressCurve& curve, const CurveProperty& property)
{
    if (curve.empty()) return;
    std::cout << "    " << property.name << " =";
    for (const Vec2& point : measured_ends(curve, property.measure)) std::cout << " " << point.x() << ":" << point.y();
    std::cout << " " << (property.measure == CurveMeasure::tension ? "m/m:N/m" : "rad:N/m") << ", then "
              << curve.back().slope << " N/m\n";
}

void print_text()
{
    for (const std::string& name : fabric_preset_names()) {
        const Fabric fabric = fabric_preset(name);
        std::cout << name << '\n';
        for (const Property& property : properties) {
            const double value = fabric.*property.value;
            std::cout << "    " << property.name << " = ";
            if (std::isnan(value))
                std::cout << "automatic\n";
            else
                std::cout << value << " " << property.unit << '\n';
        }
        for (const CurveProperty& property : curves) print_curve(fabric.*property.curve, property);
        std::cout << "    source: " << fabric.source << '\n';
    }
}

}  // namespace

void add_fabrics_command(CLI::App& program, Action& chosen)
{
    auto json = std::make_shared<bool>(false);
    CLI::App* command =
        program.add_subcommand("fabrics", "List the built-in fabrics, their values and where these come from");
    command->add_flag("--json", *json, "print JSON");
    command->footer("Example:\n  selvage fabrics --json");
    command->callback([json, &chosen] {
        chosen = [json] {
            *json ? print_json() : print_text();
            return 0;
        };
    });
}

}  // namespace selvage
