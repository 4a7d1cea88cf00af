#include "validation/fuzz/resumed_run.hpp"

#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <stdexcept>

#include <sys/wait.h>
#include <unistd.h>

#include "host/run/phase_memory.hpp"
#include "host/run/restart.hpp"
#include "host/scene/plan.hpp"
#include "host/scene/run_settings.hpp"
#include "host/scene/scene_model.hpp"
#include "host/solver/stepping/step_failure.hpp"
#include "io/scene/read_scene.hpp"

namespace selvage {
namespace {

constexpr int steps_before = 40;  // by then the sheets touch each other and the ball
const std::vector<std::string> integrator_names = {"bdf2", "central_difference"};

constexpr const char* scene_name = "/falling.toml";
constexpr const char* scene_text = R"(
sheet = [{width = 0.3, height = 0.3, resolution = 7, center = [0, 0, 0.112]},
         {width = 0.2, height = 0.2, resolution = 6, center = [0.05, 0.03, 0.135], rotation = [8, 0, 30]}]
body = [{shape = "sphere", radius = 0.1, center = [0, 0, 0]}]
solver = {until = 1, step = 0.004}
)";

// Two sheets that fall on a ball, with one of the integrators.
class FallingSheets {
public:
    /// @param folder  in which the scene lies
    FallingSheets(const std::string& folder, const std::string& integrator)
        : scene_(read_scene(folder + scene_name, std::vector<std::string>{"solver.integrator=" + integrator})),
          model_(build_scene_model(scene_)), settings_(make_run_settings(scene_, model_)),
          identity_(identity_of(settings_, model_)),
          query_(model_.cloth_model.bodies, cloth_reach(model_.cloth_model.cloth)),
          phase_(model_.cloth_model, settings_.cloth.draping, &query_, profile_, model_.cloth_model.cloth.positions,
                 {}),
          integrator_(make_integrator(integrator, phase_))
    {
    }

    void step(int count)
    {
        EquilibriumOptions options = settings_.drape;
        options.integrator = integrator_.get();
        drape_until(phase_, options, settings_.until.time, 1 / settings_.frame_rate, progress_.draping,
                    [&](const StepEvent&) { return --count > 0; });
    }
    void save(const std::string& path) const { save_run(path, identity_, progress_, phase_, *integrator_); }
    void load(const Checkpoint& checkpoint, const std::string& path)
    {
        progress_ = load_progress(checkpoint, path, identity_);
        load_phase(checkpoint, path, phase_, *integrator_);
        try {
            step(1);
        } catch (const StepFailureError&) {  // of a state that cannot be
        } catch (const UnstableStepError&) {
        }
    }

private:
    Scene scene_;
    SceneModel model_;
    RunSettings settings_;
    RunIdentity identity_;
    BodyQuery query_;
    Profile profile_;
    Phase phase_;
    std::unique_ptr<Integrator> integrator_;
    RunProgress progress_;
};

}  // namespace

std::vector<std::string> resumed_corpus(const std::string& folder)
{
    std::ofstream(folder + scene_name) << scene_text;
    std::vector<std::string> corpus;
    for (const std::string& integrator : integrator_names) {
        const std::string path = folder + "/corpus.h5";
        // In a process of its own: inputs are executed by copies of this one, which must have no threads yet.
        const pid_t child = fork();
        if (child == 0) {
            FallingSheets sheets(folder, integrator);
            sheets.step(steps_before);
            sheets.save(path);
            _exit(0);
        }
        int status = 0;
        if (child < 0 || waitpid(child, &status, 0) != child || status != 0)
            throw std::runtime_error("no checkpoint of a run with " + integrator);
        std::ifstream file(path, std::ios::binary);
        corpus.emplace_back(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>());
        std::filesystem::remove(path);
    }
    return corpus;
}

void go_on_from(const std::string& path)
{
    const Checkpoint checkpoint = read_checkpoint(path);
    const auto word = checkpoint.words.find("integrator");
    const bool is_last = word != checkpoint.words.end() && word->second == integrator_names.back();
    const std::string folder = std::filesystem::path(path).parent_path().string();
    FallingSheets(folder, is_last ? integrator_names.back() : integrator_names.front()).load(checkpoint, path);
}

}  // namespace selvage
