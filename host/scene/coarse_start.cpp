#include "host/scene/coarse_start.hpp"

#include "host/scene/scene_pins.hpp"

namespace selvage {
namespace {

constexpr double coarsest_edge = 0.025;  // [m], of garments: longer ones do not lie around arms as the finer ones will
// Levels below a garment: with one, its own drape costs as much as sewing on the coarser mesh saves.
constexpr std::size_t worth_sewing_first = 2;

}  // namespace

std::size_t levels_used(const Scene& scene, const SceneModel& model)
{
    std::size_t levels = model.cloth_model.coarser.size();
    while (scene.has_garment() && levels > 0 && typical_edge(model.cloth_model.coarser[levels - 1]) > coarsest_edge)
        --levels;
    return levels;
}

std::string why_no_coarse_start(const Scene& scene, const SceneModel& model)
{
    const IntegratorChoice integrator = scene.solver.integrator;
    if (!scene.solver.progressive) return "solver.progressive is false";
    if (!scene.until().equilibrium) return "the run shows a motion (solver.until)";
    if (integrator != IntegratorChoice::automatic && integrator != IntegratorChoice::implicit_euler &&
        integrator != IntegratorChoice::quasistatic)
        return "solver.integrator asks for another way to rest";
    if (pins_by_index(scene)) return "vertices are held by their indices, which coarser meshes do not have";
    if (scene.moves()) return "held vertices or bodies move, and the cloth has to follow";
    if (!scene.has_garment() && !model.cloth_model.bodies.empty())
        return "there are bodies, and what the cloth meets first decides where it lies";
    if (scene.solver.load_steps > 1) return "the weight grows in steps (solver.load_steps)";
    if (scene.bending.hysteresis) return "bending hysteresis remembers the way (bending.hysteresis)";
    const std::size_t levels = levels_used(scene, model);
    if (levels == 0) return "there are no coarser meshes of the cloth";
    if (scene.has_garment() && levels < worth_sewing_first) return "the garment is coarse enough to be sewn as it is";
    return "";
}

}  // namespace selvage
