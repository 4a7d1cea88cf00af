#include <iostream>
#include <memory>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "host/commands/commands.hpp"
#include "io/scene.hpp"

namespace selvage {
namespace {

struct Property {
    const char* name;
    const char* unit;
    double Fabric::*value;
};

// Names and units come from the list of scene keys, so a new property shows up here by itself.
#define PROPERTY(type, name, initial, unit, low, high, meaning) {#name, unit, &Fabric::name},
#define NOT_A_NUMBER(name, initial, choices, meaning)
constexpr Property properties[] = {FABRIC_KEYS(PROPERTY, NOT_A_NUMBER)};
#undef PROPERTY
#undef NOT_A_NUMBER

void print_json()
{
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (const std::string& name : fabric_preset_names()) {
        const Fabric fabric = fabric_preset(name);
        nlohmann::ordered_json entry{{"name", name}};
        for (const Property& property : properties) entry[property.name] = fabric.*property.value;
        entry["source"] = fabric.source;
        list.push_back(entry);
    }
    std::cout << list.dump(2) << '\n';
}

void print_text()
{
    for (const std::string& name : fabric_preset_names()) {
        const Fabric fabric = fabric_preset(name);
        std::cout << name << '\n';
        for (const Property& property : properties)
            std::cout << "    " << property.name << " = " << fabric.*property.value << " " << property.unit << '\n';
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
