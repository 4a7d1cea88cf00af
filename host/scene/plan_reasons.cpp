#include "host/scene/plan_reasons.hpp"

namespace selvage {
namespace {

constexpr double coarsest_edge = 0.025;  // [m], of garments: longer ones do not lie around arms as the finer ones will
// Levels below a garment: with one, its own drape costs as much as sewing on the coarser mesh saves.
constexpr std::size_t worth_sewing_first = 2;

}  // namespace

std::string absence_of_contact(const Scene& scene, bool bodies, std::string_view name)
{
    const std::string &response = scene.contact.response, in_place = "contact.response is " + response;
    const bool of_cloth = name.starts_with("cloth_"), rule = response == "velocity_rule";
    if (of_cloth && !scene.contact.self) return "contact.self is false";
    if (of_cloth && rule) return in_place + ", which knows of bodies only";
    if (!of_cloth && !bodies) return "there are no bodies";
    if (!of_cloth && !scene.contact.body) return "contact.body is false";
    if (name == "friction" && rule) return in_place + ", which has friction of its own";
    if (name == "friction") return "no body and no fabric has friction";
    if (name == "cloth_friction") return "no fabric has friction";
    return in_place;
}

std::string absence(const Scene& scene, const SceneModel& model, std::string_view term)
{
    if (term == "gravity") return "solver.gravity is zero";
    const bool springs = scene.membrane.model == "springs", bend_springs = scene.bending.model == "springs";
    const bool membrane = scene.membrane.model != "none" && scene.membrane.scale > 0;
    if (term == "spring") return "neither membrane.model nor bending.model is springs";
    if ((term == "membrane" || term == "curved_membrane") && springs) return "membrane.model is springs";
    if ((term == "bending" || term == "plate") && (bend_springs || (springs && scene.bending.model == "automatic")))
        return "bend springs are in its place (bending.model)";
    if (term == "bending" && scene.bending.model != "hinge" && scene.bending.model != "none")
        return "coupled hinges are in its place (bending.model)";
    if (term == "plate" && scene.bending.model == "hinge") return "plain hinges are in its place (bending.model)";
    if (term == "membrane" && membrane) return "a fabric has a stress curve or limit: curved_membrane is in its place";
    if (term == "curved_membrane" && membrane) return "no fabric has a stress curve or limit";
    if (term == "membrane" || term == "curved_membrane") return "membrane.model is none or its scale is zero";
    if (term == "bending" || term == "plate") return "bending.model is none, or no fabric has a bending rigidity";
    if (term == "bending_hysteresis" && !scene.bending.hysteresis) return "bending.hysteresis is false";
    if (term == "bending_hysteresis") return "bending.model is none, or no fabric has bending hysteresis";
    if (term == "seam") return "there are no seams";
    if (term == "damping") return "no fabric has damping";
    return absence_of_contact(scene, !model.model.bodies.empty(), term);
}

std::size_t levels_used(const Scene& scene, const SceneModel& model)
{
    std::size_t levels = model.model.coarser.size();
    while (scene.has_garment() && levels > 0 && typical_edge(model.model.coarser[levels - 1]) > coarsest_edge) --levels;
    return levels;
}

std::string why_no_coarse_start(const Scene& scene, const SceneModel& model)
{
    const std::string& integrator = scene.solver.integrator;
    if (!scene.solver.progressive) return "solver.progressive is false";
    if (scene.solver.until != "equilibrium") return "the run shows a motion (solver.until)";
    if (integrator != "automatic" && integrator != "implicit_euler" && integrator != "static")
        return "solver.integrator asks for another way to rest";
    if (scene.moves()) return "held vertices or bodies move, and the cloth has to follow";
    if (!scene.has_garment() && !model.model.bodies.empty())
        return "there are bodies, and what the cloth meets first decides where it lies";
    if (scene.solver.load_steps > 1) return "the weight grows in steps (solver.load_steps)";
    if (scene.bending.hysteresis) return "bending hysteresis remembers the way (bending.hysteresis)";
    const std::size_t levels = levels_used(scene, model);
    if (levels == 0) return "there are no coarser meshes of the cloth";
    if (scene.has_garment() && levels < worth_sewing_first) return "the garment is coarse enough to be sewn as it is";
    return "";
}

}  // namespace selvage
