#include <filesystem>
#include <iostream>
#include <memory>

#include <CLI/CLI.hpp>

#include "host/commands/commands.hpp"
#include "host/run/render_run.hpp"

namespace selvage {
namespace {

struct RenderArguments {
    std::string run;
    std::string picture;
    int frame = -1;
    int width = 1600;
    std::string bodies;
};

int render(const RenderArguments& arguments)
{
    const std::string picture = arguments.picture.empty()
                                    ? std::filesystem::path(arguments.run).replace_extension(".png").string()
                                    : arguments.picture;
    render_run(arguments.run, picture, arguments.frame, arguments.width, arguments.bodies);
    std::cerr << "wrote " << picture << '\n';
    return 0;
}

}  // namespace

void add_render_command(CLI::App& program, Action& chosen)
{
    auto arguments = std::make_shared<RenderArguments>();
    CLI::App* command = program.add_subcommand("render", "Draw a frame of a run with its bodies");
    command->add_option("RUN", arguments->run, "run.h5 of a finished or broken-off run")->required();
    command->add_option("-o,--output", arguments->picture, "picture to write; default: RUN with the ending .png")
        ->type_name("PNG");
    command->add_option("--frame", arguments->frame, "frame, counted from 0; -1: the last one")->capture_default_str();
    command->add_option("--width", arguments->width, "width of the picture in pixels")
        ->check(CLI::Range(64, 16384))
        ->capture_default_str();
    command->add_option("--bodies", arguments->bodies, "also write the bodies as they are in that frame")
        ->type_name("OBJ");
    command->footer("Example:\n  selvage render out/run.h5 --frame 12 -o frame12.png");
    command->callback([arguments, &chosen] { chosen = [arguments] { return render(*arguments); }; });
}

}  // namespace selvage
