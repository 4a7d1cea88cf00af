#include <iostream>
#include <memory>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "host/commands/commands.hpp"
#include "host/styles/styles.hpp"
#include "io/atomic_file.hpp"
#include "io/pattern/write_pattern.hpp"

namespace selvage {
namespace {

struct StylesArguments {
    std::string style, output;
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

int run_styles(const StylesArguments& arguments)
{
    if (arguments.style.empty()) {
        list_styles(arguments.json);
        return 0;
    }
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
    add_body_options(*command, arguments->body);
    command->add_flag("--json", arguments->json, "print the list as JSON");
    command->footer(
        "Example:\n"
        "  selvage styles\n"
        "  selvage styles tshirt --body body.obj --up y -o tshirt.json\n"
        "  selvage styles vest --set body[0].size=L -o vest_L.json");
    command->callback([arguments, &chosen] { chosen = [arguments] { return run_styles(*arguments); }; });
}

}  // namespace selvage
