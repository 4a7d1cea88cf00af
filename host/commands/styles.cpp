#include <iostream>
#include <memory>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "host/commands/commands.hpp"
#include "host/scene/measured_body.hpp"
#include "host/styles/styles.hpp"
#include "io/atomic_file.hpp"
#include "io/pattern/write_pattern.hpp"

namespace selvage {
namespace {

struct StylesArguments {
    std::string style, output, unit = "m", up = "z";
    BodySource body{.source = "builtin:mannequin", .overrides = {}};
    bool json = false;
};

void list_styles(bool json)
{
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (const Style& style : styles()) {
        if (json)
            list.push_back(
                {{"name", style.name}, {"summary", style.summary}, {"scene", "builtin:" + std::string(style.name)}});
        else
            std::cout << style.name << "\n    " << style.summary << '\n';
    }
    if (json) std::cout << list.dump(2) << '\n';
}

int run_styles(StylesArguments arguments)
{
    if (arguments.style.empty()) {
        list_styles(arguments.json);
        return 0;
    }
    arguments.body.unit = *find_word<LengthUnit>(arguments.unit);
    arguments.body.up_axis = *find_word<Axis>(arguments.up);
    find_style(arguments.style, "STYLE");  // a wrong name is told before a body is read
    const StyleBody body = style_body(load_measured_body(arguments.body), {arguments.body.source, 0, 0, {}});
    const std::string text = pattern_json(draft_style(arguments.style, body));
    if (arguments.output.empty()) {
        std::cout << text;
        return 0;
    }
    write_file_atomically(arguments.output, text);
    std::cerr << "wrote " << arguments.output << '\n';
    return 0;
}

}  // namespace

void add_styles_command(CLI::App& program, Action& chosen)
{
    auto arguments = std::make_shared<StylesArguments>();
    CLI::App* command = program.add_subcommand(
        "styles", "List the garments that can be drafted from body measures, or write one as a pattern file");
    command->add_option("STYLE", arguments->style, "garment to draft; none: list all");
    command
        ->add_option("--body", arguments->body.source,
                     "body to draft for: OBJ file; or a scene, whose first body is measured; builtin:mannequin")
        ->capture_default_str();
    command->add_option("-o,--output", arguments->output, "pattern to write (GarmentCode JSON); none: to stdout")
        ->type_name("FILE");
    command->add_option("--unit", arguments->unit, "length unit of the OBJ file")
        ->check(CLI::IsMember(words_for_option(words_of<LengthUnit>())))
        ->capture_default_str();
    command->add_option("--up", arguments->up, "up direction of the OBJ file")
        ->check(CLI::IsMember(words_for_option(words_of<Axis>())))
        ->capture_default_str();
    command->add_option("--scale", arguments->body.scale, "scales the OBJ file")
        ->check(CLI::Range(1e-4, 1e4))
        ->capture_default_str();
    command->add_option("--set", arguments->body.overrides, "set a key of the scene; may be repeated")
        ->type_name("TABLE.KEY=VALUE")
        ->allow_extra_args(false);
    command->add_flag("--json", arguments->json, "print the list as JSON");
    command->footer(
        "Example:\n"
        "  selvage styles\n"
        "  selvage styles tshirt --body body.obj --up y -o tshirt.json\n"
        "  selvage styles vest --set body[0].size=L -o vest_L.json");
    command->callback([arguments, &chosen] { chosen = [arguments] { return run_styles(*arguments); }; });
}

}  // namespace selvage
