#include <fstream>
#include <iostream>
#include <memory>
#include <optional>

#include <CLI/CLI.hpp>

#include "host/commands/commands.hpp"
#include "host/run/interrupt.hpp"
#include "host/run/run.hpp"
#include "io/scene/read_scene.hpp"
#include "io/scene/scene.hpp"

namespace selvage {
namespace {

struct DrapeArguments {
    SceneChoice scene;
    RunOptions run;
    std::optional<int> threads;
    std::string precision;
    bool json = false;
};

int drape(DrapeArguments arguments)
{
    if (arguments.threads) arguments.scene.overrides.push_back("solver.threads=" + std::to_string(*arguments.threads));
    if (!arguments.precision.empty()) arguments.scene.overrides.push_back("solver.precision=" + arguments.precision);
    const Scene scene = read_scene(arguments.scene.source, arguments.scene.overrides);

    install_interrupt_handler();
    const RunOutcome outcome = run_drape(scene, arguments.run);
    if (!outcome.message.empty()) std::cerr << outcome.message << '\n';
    if (arguments.json) std::cout << std::ifstream(outcome.folder + "/summary.json").rdbuf();
    return outcome.exit_code;
}

}  // namespace

void add_drape_command(CLI::App& program, Action& chosen)
{
    auto arguments = std::make_shared<DrapeArguments>();
    CLI::App* command =
        program.add_subcommand("drape", "Sew and drape a scene; writes the motion, its last frame and a picture");
    add_scene_options(*command, arguments->scene, "builtin:tshirt");
    command->add_option("-o,--output", arguments->run.folder, "folder for the results")
        ->type_name("DIR")
        ->capture_default_str();
    command->add_option("--threads", arguments->threads, "worker threads; 0: all cores (solver.threads)")
        ->type_name("N");
    command->add_option("--precision", arguments->precision, "precision of the linear solves (solver.precision)")
        ->check(CLI::IsMember({"float", "double"}))
        ->type_name("float|double");
    command->add_flag(
        "--resume", arguments->run.resume,
        "go on from the checkpoint in the output folder as the unbroken run would; without one start anew");
    command->add_flag("--quiet", arguments->run.quiet, "no progress on stderr");
    command->add_flag("--profile", arguments->run.profile,
                      "print what each phase costs; writes trace.json, to be opened in Perfetto");
    command->add_flag("--json", arguments->json, "print summary.json on stdout at the end");
    command->footer(
        "Example:\n"
        "  selvage drape builtin:tshirt -o out --set garment.resolution=0.01 --set garment.fabric=silk\n"
        "Exit codes: 0 done, 2 bad input or unwritable output, 3 diverged, 4 not converged within the limits, 128 + "
        "signal interrupted.");
    command->callback([arguments, &chosen] { chosen = [arguments] { return drape(*arguments); }; });
}

}  // namespace selvage
