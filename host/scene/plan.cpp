#include "host/scene/plan.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "host/run/progressive.hpp"
#include "host/solver/state/springs.hpp"
#include "host/solver/terms/rules.hpp"

namespace selvage {
namespace {

// Entries of the plate's matrix per hinge on irregular meshes, where it is fullest.
constexpr int couplings_per_hinge = 28;

bool any_fabric(const SceneModel& model, double Fabric::*property)
{
    return std::any_of(model.model.fabrics.begin(), model.model.fabrics.end(),
                       [&](const auto& entry) { return entry.second.*property > 0; });
}

bool any_curve(const SceneModel& model)
{
    return std::any_of(model.model.fabrics.begin(), model.model.fabrics.end(),
                       [](const auto& entry) { return has_curves(entry.second); });
}

double contact_stiffness(const Scene& scene, const SceneModel& model)
{
    if (!std::isnan(scene.contact.stiffness)) return scene.contact.stiffness;
    double heaviest = 0;
    for (const auto& [name, fabric] : model.model.fabrics) heaviest = std::max(heaviest, fabric.areal_density);
    const double gravity = scene.solver.gravity.norm();
    double fastest = 0;
    for (const Body& body : model.model.bodies) {
        if (!body.motion) continue;
        Box box;
        for (const Vec3& x : body.mesh.vertices) box.extend(x);
        fastest = std::max(fastest, body.motion->highest_speed(box));
    }
    // What a body drives before it has to gain its speed within the gap.
    return heaviest * std::max(100 * (gravity > 0 ? gravity : 9.81), fastest * fastest / scene.contact.gap);
}

// Where cloth begins to press on cloth: at its thickness, or at contact.gap if that is more, but well below the length
// of an edge and below the height of any triangle, since neighbours in a panel must not press on each other.
double cloth_gap(const Scene& scene, const SceneModel& model)
{
    double thickest = scene.contact.gap;
    for (const auto& [name, fabric] : model.model.fabrics) thickest = std::max(thickest, fabric.thickness);
    return std::min({thickest, 0.4 * model.edge_length, 0.8 * model.least_height});
}

bool any_friction(const SceneModel& model)
{
    const auto rubs = [&](const Body& body) {
        return std::isnan(body.friction) ? any_fabric(model, &Fabric::friction) : body.friction > 0;
    };
    return std::any_of(model.model.bodies.begin(), model.model.bodies.end(), rubs);
}

bool any_hysteresis(const SceneModel& model)
{
    return any_fabric(model, &Fabric::hysteresis_weft) || any_fabric(model, &Fabric::hysteresis_warp);
}

// Exactly one law of contact gets a strength. The cloth slides freely while it is sewn: friction would hold it where
// the panels first touched the body.
void set_contact(Params& params, const Scene& scene, const SceneModel& model, bool sewing)
{
    const bool bodies = !model.model.bodies.empty() && scene.contact.body;
    const double friction = bodies && !sewing && any_friction(model) ? 1 : 0;
    if (scene.contact.response == "velocity_rule") {
        if (!bodies) return;
        params.velocity_rule.gap = scene.contact.gap;
        params.velocity_rule.restitution = std::isnan(scene.contact.restitution) ? 0 : scene.contact.restitution;
        params.velocity_rule.friction = friction;
        return;
    }
    const auto press = [&](auto& law, double gap) {
        law.stiffness = contact_stiffness(scene, model);
        law.gap = gap;
    };
    const bool exponential = scene.contact.response == "exponential";
    if (scene.contact.self) {
        const double gap = cloth_gap(scene, model);
        exponential ? press(params.cloth_repulsion, gap) : press(params.cloth_contact, gap);
        params.cloth_friction.scale = !sewing && any_fabric(model, &Fabric::friction) ? 1 : 0;
    }
    if (!bodies) return;
    exponential ? press(params.body_repulsion, scene.contact.gap) : press(params.body_contact, scene.contact.gap);
    params.friction.scale = friction;
}

Params phase_params(const Scene& scene, const SceneModel& model, bool sewing)
{
    Params params;
    if (!sewing) {
        params.gravity.acceleration_x = scene.solver.gravity.x();
        params.gravity.acceleration_y = scene.solver.gravity.y();
        params.gravity.acceleration_z = scene.solver.gravity.z();
    }
    const double membrane = scene.membrane.model == "none" ? 0 : scene.membrane.scale;
    double& strength = scene.membrane.model == "springs" ? params.spring.scale
                       : any_curve(model)                ? params.curved_membrane.scale
                                                         : params.membrane.scale;
    strength = membrane;
    const bool bends = any_fabric(model, &Fabric::bending_weft) || any_fabric(model, &Fabric::bending_warp);
    const bool bend_springs =
        scene.bending.model == "springs" || (scene.bending.model == "automatic" && scene.membrane.model == "springs");
    const bool plates = scene.bending.model == "plate" || (scene.bending.model == "automatic" && !bend_springs);
    (bend_springs ? params.spring.bend_scale
     : plates     ? params.plate.scale
                  : params.bending.scale) = scene.bending.model == "none" || !bends ? 0 : scene.bending.scale;
    // Sewing is not how a garment came to its shape: hysteresis would only keep the folds it left.
    const bool hysteresis = scene.bending.hysteresis && scene.bending.model != "none" && !sewing;
    params.bending_hysteresis.scale = hysteresis && any_hysteresis(model) ? 1 : 0;
    params.damping.scale = any_fabric(model, &Fabric::damping) ? 1 : 0;
    if (sewing) {
        params.bending.scale *= scene.seams.stiffening;
        params.plate.scale *= scene.seams.stiffening;
        params.spring.bend_scale *= scene.seams.stiffening;
        // A stitch stands for one edge length of seam, so that sewing does not depend on the resolution.
        params.seam.stiffness = scene.seams.stiffness * model.edge_length;
        params.seam.force_limit = scene.seams.force_limit * model.edge_length;
    }
    set_contact(params, scene, model, sewing);
    return params;
}

std::size_t solver_estimate(const Scene& scene, const mesh_sizes& size, bool levels)
{
    const std::size_t scalar = scene.solver.precision == "float" ? 4 : 8;
    const std::size_t blocks = std::size_t(size.vertex_count) + 2 * std::size_t(size.face_count) * 3 / 2 +
                               2 * std::size_t(size.hinge_count) + 2 * std::size_t(size.spring_count);
    const std::size_t matrix = blocks * (9 * scalar + 4) + std::size_t(size.vertex_count) * (9 + 15) * scalar;
    const std::size_t places = 2 * (9 * std::size_t(size.face_count) + 16 * std::size_t(size.hinge_count) +
                                    4 * std::size_t(size.spring_count));
    // Coarse matrices are a third of the finest one; the plan of their products holds nine entries per fine block.
    return matrix + places + (levels ? matrix / 3 + 9 * 4 * blocks * 4 / 3 : 0);
}

PhasePlan plan_phase(const Scene& scene, const SceneModel& model, bool sewing)
{
    PhasePlan phase;
    phase.name = sewing ? "sew" : "drape";
    phase.params = phase_params(scene, model, sewing);
    phase.joined = !sewing;
    phase.queries_bodies = meets_bodies(phase.params);
    Topology topology = make_topology(model.model.cloth, phase.joined);
    add_springs(topology, model.model.cloth, model.model.fabrics, springs_of(phase.params));
    const bool plate = phase.params.plate.scale > 0;
    const mesh_sizes size = topology_sizes(topology, int(model.model.fabrics.size()),
                                           plate ? couplings_per_hinge * int(topology.hinges.size()) : 0);
    for (const Term& term : all_terms())
        if (term.is_active(phase.params))
            phase.launches.push_back({std::string(term.name), std::string(kind_name(term.per)), term.item_count(size),
                                      std::size_t(term.item_count(size)) * std::size_t(term.bytes_per_item)});
    for (const Rule& rule : all_rules())
        if (rule.is_active(phase.params))
            phase.launches.push_back({std::string(rule.name), std::string(kind_name(rule.per)), rule.item_count(size),
                                      std::size_t(rule.item_count(size)) * std::size_t(rule.bytes_per_item)});
    if (phase.queries_bodies) phase.launches.push_back({"body_query", "vertex", size.vertex_count, 0});
    phase.field_bytes = field_bytes(size, required_fields(phase.params));
    phase.solver_bytes = solver_estimate(scene, size, !model.model.coarser.empty());
    return phase;
}

double bodies_end(const std::vector<Body>& bodies)
{
    double end = 0;
    for (const Body& body : bodies)
        if (body.motion) end = std::max(end, body.motion->end());
    return end;
}

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

}  // namespace

RunPlan make_plan(const Scene& scene, const SceneModel& model)
{
    RunPlan plan;
    if (model.sews) plan.phases.push_back(plan_phase(scene, model, true));
    plan.phases.push_back(plan_phase(scene, model, false));
    for (const Term& term : all_terms()) {
        const bool used = std::any_of(plan.phases.begin(), plan.phases.end(),
                                      [&](const PhasePlan& phase) { return term.is_active(phase.params); });
        if (used)
            plan.active.push_back(std::string(term.name));
        else
            plan.skipped.push_back({std::string(term.name), absence(scene, model, term.name)});
    }
    for (const Rule& rule : all_rules())
        if (rule.is_active(plan.phases.back().params))
            plan.active.push_back(std::string(rule.name));
        else
            plan.skipped.push_back(
                {std::string(rule.name), absence_of_contact(scene, !model.model.bodies.empty(), rule.name)});
    const bool queries = plan.phases.back().queries_bodies;
    const bool queries_meshes = queries && std::any_of(model.model.bodies.begin(), model.model.bodies.end(),
                                                       [](const Body& body) { return body.kind == Body::Kind::mesh; });
    plan.embree = queries_meshes || scene.output.picture;
    if (plan.embree)
        plan.active.push_back("embree");
    else
        plan.skipped.push_back({"embree", queries ? "all bodies have closed forms, and no picture is drawn"
                                                  : "no body is queried and no picture is drawn"});
    if (scene.output.picture)
        plan.active.push_back("picture");
    else
        plan.skipped.push_back({"picture", "output.picture is false"});
    const std::string no_coarse_start = why_no_coarse_start(scene, model);
    plan.coarse_start = no_coarse_start.empty();
    if (plan.coarse_start)
        plan.active.push_back("coarse_start");
    else
        plan.skipped.push_back({"coarse_start", no_coarse_start});
    if (!model.sews) plan.skipped.push_back({"sew", "there are no seams"});
    if (scene.wind.velocity.isZero()) plan.skipped.push_back({"wind", "wind.velocity is zero"});
    const double body_end = bodies_end(model.model.bodies);
    if (!queries || body_end == 0)
        plan.skipped.push_back({"body_motion", queries ? "no body has keyframes or a sequence" : "no body is queried"});
    else
        plan.active.push_back("body_motion");
    if (model.model.cloth.pin_motions.empty())
        plan.skipped.push_back({"pin_motion", "there is no [[pins.motion]]"});
    else
        plan.active.push_back("pin_motion");

    std::size_t body_bytes = 0;
    for (const Body& body : model.model.bodies)
        body_bytes += body.mesh.faces.size() * 400 + (body.motion ? body.motion->bytes() : 0);
    for (const PhasePlan& phase : plan.phases)
        plan.peak_bytes = std::max(plan.peak_bytes, phase.field_bytes + phase.solver_bytes);
    plan.peak_bytes += model.model.cloth.positions.size() * 500 + body_bytes + (std::size_t(100) << 20);
    return plan;
}

void check_memory(const Scene& scene, const RunPlan& plan)
{
    const double limit = memory_limit(scene);
    if (double(plan.peak_bytes) <= limit) return;
    const std::string key = scene.has_garment() ? "garment.resolution" : "sheet[0].resolution";
    throw InputError(scene.place(key),
                     fmt::format("a resolution whose run needs about {:.1f} GiB", double(plan.peak_bytes) / (1 << 30)),
                     fmt::format("at most {:.1f} GiB (solver.memory_limit)", limit / (1 << 30)));
}

}  // namespace selvage
