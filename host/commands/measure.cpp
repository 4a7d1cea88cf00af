#include <iostream>
#include <memory>

#include <CLI/CLI.hpp>

#include "host/body/body_measures.hpp"
#include "host/body/body_picture.hpp"
#include "host/body/body_report.hpp"
#include "host/commands/commands.hpp"

namespace selvage {
namespace {

struct MeasureArguments {
    BodySource body;
    std::string picture;
    int width = 1600;
    bool json = false;
};

int measure(const MeasureArguments& arguments)
{
    const TriangleMesh mesh = load_measured_body(arguments.body);
    const BodyMeasures measures = measure_body(mesh, {arguments.body.source, 0, 0, {}});
    std::cout << (arguments.json ? measures_json(measures, arguments.body.source)
                                 : measures_text(measures, arguments.body.source));
    if (!arguments.picture.empty()) {
        write_png(arguments.picture, draw_measures(mesh, measures, arguments.width));
        std::cerr << "wrote " << arguments.picture << '\n';
    }
    return 0;
}

}  // namespace

void add_measure_command(CLI::App& program, Action& chosen)
{
    auto arguments = std::make_shared<MeasureArguments>();
    CLI::App* command = program.add_subcommand(
        "measure",
        "Find parts, landmarks, girths and lengths of a body from its shape, in any pose in which it stands");
    command
        ->add_option(
            "BODY", arguments->body.source,
            "OBJ file; or a scene, whose first body is measured: a TOML file or builtin:NAME; builtin:mannequin")
        ->required();
    command
        ->add_option("-o,--output", arguments->picture,
                     "picture to write: parts, measures and landmarks, from front and side")
        ->type_name("PNG");
    add_body_options(*command, arguments->body);
    command->add_option("--width", arguments->width, "width of the picture in pixels")
        ->check(CLI::Range(64, 16384))
        ->capture_default_str();
    command->add_flag("--json", arguments->json, "print JSON in SI units, with the part of each vertex");
    command->footer(
        "Example:\n"
        "  selvage measure body.obj --unit cm --up y -o body.png\n"
        "  selvage measure builtin:mannequin --set body[0].size=L");
    command->callback([arguments, &chosen] { chosen = [arguments] { return measure(*arguments); }; });
}

}  // namespace selvage
