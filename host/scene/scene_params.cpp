#include "host/scene/scene_params.hpp"

#include <algorithm>
#include <cmath>

namespace selvage {
namespace {

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

}  // namespace

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

}  // namespace selvage
