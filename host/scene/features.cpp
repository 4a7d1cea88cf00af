#include "host/scene/features.hpp"

#include <algorithm>
#include <cmath>

#include "host/model/body.hpp"
#include "host/scene/coarse_start.hpp"
#include "host/solver/terms/terms.hpp"
#include "host/solver/terms/velocity_filters.hpp"

namespace selvage {
namespace {

constexpr const char* on = "";  // the reason of a feature that is on

bool any_fabric(const SceneModel& model, double Fabric::*property)
{
    return std::any_of(model.cloth_model.fabrics.begin(), model.cloth_model.fabrics.end(),
                       [&](const auto& entry) { return entry.second.*property > 0; });
}

bool any_curve(const SceneModel& model)
{
    return std::any_of(model.cloth_model.fabrics.begin(), model.cloth_model.fabrics.end(),
                       [](const auto& entry) { return has_curves(entry.second); });
}

// External forces and damping ----------------------------------------------

std::string gravity(const FeatureCase& with, Params& params)
{
    const Vec3& acceleration = with.scene.solver.gravity;
    if (acceleration.isZero()) return "solver.gravity is zero";
    if (with.sewing) return "panels are sewn without weight";
    params.gravity.acceleration_x = acceleration.x();
    params.gravity.acceleration_y = acceleration.y();
    params.gravity.acceleration_z = acceleration.z();
    return on;
}

std::string damping(const FeatureCase& with, Params& params)
{
    if (!any_fabric(with.model, &Fabric::damping)) return "no fabric has damping";
    params.damping.scale = 1;
    return on;
}

// The law of air that moves past faces; its velocity follows while the phase runs.
void set_air(const WindScene& wind, auto& term)
{
    term.normal = wind.density * wind.normal_coefficient;
    term.tangential = wind.density * wind.tangential_coefficient;
}

std::string wind(const FeatureCase& with, Params& params)
{
    if (!with.scene.wind_blows()) return "wind.velocity and wind.gust are zero";
    if (with.sewing) return "panels are sewn without wind";
    set_air(with.scene.wind, params.wind);
    return on;
}

std::string air_drag(const FeatureCase& with, Params& params)
{
    if (!with.scene.has_air()) return "wind.velocity and wind.gust are zero and wind.still_air is false";
    if (with.sewing) return "panels are sewn without air";
    set_air(with.scene.wind, params.air_drag);
    return on;
}

// The membrane ----------------------------------------------

std::string why_no_faces(const MembraneScene& membrane)
{
    if (membrane.model == MembraneModel::springs) return "membrane.model is springs";
    if (membrane.model == MembraneModel::none || membrane.scale == 0)
        return "membrane.model is none or its scale is zero";
    return on;
}

std::string membrane(const FeatureCase& with, Params& params)
{
    if (const std::string reason = why_no_faces(with.scene.membrane); !reason.empty()) return reason;
    if (any_curve(with.model)) return "a fabric has a stress curve or limit: curved_membrane is in its place";
    params.membrane.scale = with.scene.membrane.scale;
    return on;
}

std::string curved_membrane(const FeatureCase& with, Params& params)
{
    if (const std::string reason = why_no_faces(with.scene.membrane); !reason.empty()) return reason;
    if (!any_curve(with.model)) return "no fabric has a stress curve or limit";
    params.curved_membrane.scale = with.scene.membrane.scale;
    return on;
}

// Bending ----------------------------------------------

bool has_bend_springs(const Scene& scene)
{
    return scene.bending.model == BendingModel::springs ||
           (scene.bending.model == BendingModel::automatic && scene.membrane.model == MembraneModel::springs);
}

// What multiplies the fabrics' rigidities; stiff panels do not fold over while they are sewn.
double bending_scale(const FeatureCase& with)
{
    const bool bends = any_fabric(with.model, &Fabric::bending_weft) || any_fabric(with.model, &Fabric::bending_warp);
    if (!bends || with.scene.bending.model == BendingModel::none) return 0;
    return with.sewing ? with.scene.bending.scale * with.scene.seams.stiffening : with.scene.bending.scale;
}

std::string spring(const FeatureCase& with, Params& params)
{
    const bool stretches = with.scene.membrane.model == MembraneModel::springs, bends = has_bend_springs(with.scene);
    const bool elastic = !with.model.cloth_model.cloth.elastics.empty() && !with.sewing;
    if (!stretches && !bends && !elastic)
        return "neither membrane.model nor bending.model is springs, and no elastic pulls";
    if (elastic) params.spring.elastic_scale = 1;
    if (stretches) params.spring.scale = with.scene.membrane.scale;
    if (bends) params.spring.bend_scale = bending_scale(with);
    return on;
}

std::string bending(const FeatureCase& with, Params& params)
{
    const BendingModel model = with.scene.bending.model;
    if (has_bend_springs(with.scene)) return "bend springs are in its place (bending.model)";
    if (model == BendingModel::automatic || model == BendingModel::plate)
        return "coupled hinges are in its place (bending.model)";
    if (bending_scale(with) == 0) return "bending.model is none, or no fabric has a bending rigidity";
    params.bending.scale = bending_scale(with);
    return on;
}

std::string plate(const FeatureCase& with, Params& params)
{
    if (has_bend_springs(with.scene)) return "bend springs are in its place (bending.model)";
    if (with.scene.bending.model == BendingModel::hinge) return "plain hinges are in its place (bending.model)";
    if (bending_scale(with) == 0) return "bending.model is none, or no fabric has a bending rigidity";
    params.plate.scale = bending_scale(with);
    return on;
}

// Sewing is not how a garment came to its shape: hysteresis would only keep the folds it left.
std::string bending_hysteresis(const FeatureCase& with, Params& params)
{
    const bool any =
        any_fabric(with.model, &Fabric::hysteresis_weft) || any_fabric(with.model, &Fabric::hysteresis_warp);
    if (!with.scene.bending.hysteresis) return "bending.hysteresis is false";
    if (!any || with.scene.bending.model == BendingModel::none)
        return "bending.model is none, or no fabric has bending hysteresis";
    if (with.sewing) return "sewing leaves no folds behind";
    params.bending_hysteresis.scale = 1;
    return on;
}

// Seams ----------------------------------------------

// A stitch stands for one edge length of seam, so that sewing does not depend on the resolution.
std::string seam(const FeatureCase& with, Params& params)
{
    if (!with.model.sews) return "there are no seams";
    if (!with.sewing) return "the seams are closed";
    params.seam.stiffness = with.scene.seams.stiffness * with.model.edge_length;
    params.seam.force_limit = with.scene.seams.force_limit * with.model.edge_length;
    return on;
}

// Contact: exactly one law gets a strength ----------------------------------------------

// At the heaviest fabric where no body is fast; other places have it in proportion. See local_hardness.
double stiffness_of_contact(const Scene& scene, const SceneModel& model)
{
    if (!std::isnan(scene.contact.stiffness)) return scene.contact.stiffness;
    double heaviest = 0;
    for (const auto& [name, fabric] : model.cloth_model.fabrics) heaviest = std::max(heaviest, fabric.areal_density);
    const double gravity = scene.solver.gravity.norm();
    return 100 * heaviest * (gravity > 0 ? gravity : 9.81);
}

std::string response_in_place(const Scene& scene) { return "contact.response is " + text_of(scene.contact.response); }

std::string why_not_on_bodies(const FeatureCase& with)
{
    if (with.model.cloth_model.bodies.empty()) return "there are no bodies";
    if (!with.scene.contact.body) return "contact.body is false";
    return on;
}

std::string why_not_on_cloth(const FeatureCase& with)
{
    if (!with.scene.contact.self) return "contact.self is false";
    if (with.scene.contact.response == ContactResponse::velocity_rule)
        return response_in_place(with.scene) + ", which knows of bodies only";
    return on;
}

// Of a law of contact with bodies, which is that of one response.
std::string why_no_body_law(const FeatureCase& with, ContactResponse law)
{
    if (const std::string reason = why_not_on_bodies(with); !reason.empty()) return reason;
    return with.scene.contact.response == law ? on : response_in_place(with.scene);
}

std::string why_no_cloth_law(const FeatureCase& with, ContactResponse law)
{
    if (const std::string reason = why_not_on_cloth(with); !reason.empty()) return reason;
    return with.scene.contact.response == law ? on : response_in_place(with.scene);
}

std::string body_contact(const FeatureCase& with, Params& params)
{
    if (const std::string reason = why_no_body_law(with, ContactResponse::barrier); !reason.empty()) return reason;
    params.body_contact.stiffness = stiffness_of_contact(with.scene, with.model);
    params.body_contact.gap = with.scene.contact.gap;
    return on;
}

std::string body_repulsion(const FeatureCase& with, Params& params)
{
    if (const std::string reason = why_no_body_law(with, ContactResponse::exponential); !reason.empty()) return reason;
    params.body_repulsion.stiffness = stiffness_of_contact(with.scene, with.model);
    params.body_repulsion.gap = with.scene.contact.gap;
    return on;
}

std::string cloth_contact(const FeatureCase& with, Params& params)
{
    if (const std::string reason = why_no_cloth_law(with, ContactResponse::barrier); !reason.empty()) return reason;
    params.cloth_contact.stiffness = stiffness_of_contact(with.scene, with.model);
    params.cloth_contact.gap = with.scene.contact.gap;
    return on;
}

std::string cloth_repulsion(const FeatureCase& with, Params& params)
{
    if (const std::string reason = why_no_cloth_law(with, ContactResponse::exponential); !reason.empty()) return reason;
    params.cloth_repulsion.stiffness = stiffness_of_contact(with.scene, with.model);
    params.cloth_repulsion.gap = with.scene.contact.gap;
    return on;
}

// Friction. The cloth slides freely while it is sewn: friction would hold it where the panels first touched the body.

bool any_friction(const SceneModel& model)
{
    const auto rubs = [&](const Body& body) {
        return std::isnan(body.friction) ? any_fabric(model, &Fabric::friction) : body.friction > 0;
    };
    return std::any_of(model.cloth_model.bodies.begin(), model.cloth_model.bodies.end(), rubs);
}

std::string friction(const FeatureCase& with, Params& params)
{
    if (const std::string reason = why_not_on_bodies(with); !reason.empty()) return reason;
    if (with.scene.contact.response == ContactResponse::velocity_rule)
        return response_in_place(with.scene) + ", which has friction of its own";
    if (!any_friction(with.model)) return "no body and no fabric has friction";
    if (with.sewing) return "the cloth slides while it is sewn";
    params.friction.scale = 1;
    return on;
}

std::string cloth_friction(const FeatureCase& with, Params& params)
{
    if (const std::string reason = why_not_on_cloth(with); !reason.empty()) return reason;
    if (!any_fabric(with.model, &Fabric::friction)) return "no fabric has friction";
    if (with.sewing) return "the cloth slides while it is sewn";
    params.cloth_friction.scale = 1;
    return on;
}

std::string velocity_rule(const FeatureCase& with, Params& params)
{
    if (const std::string reason = why_no_body_law(with, ContactResponse::velocity_rule); !reason.empty())
        return reason;
    const double restitution = with.scene.contact.restitution;
    params.velocity_rule.gap = with.scene.contact.gap;
    params.velocity_rule.restitution = std::isnan(restitution) ? 0 : restitution;
    params.velocity_rule.friction = any_friction(with.model) && !with.sewing ? 1 : 0;
    return on;
}

// What is neither a term nor a velocity filter ----------------------------------------------

std::string embree(const FeatureCase& with, Params& params)
{
    const std::vector<Body>& bodies = with.model.cloth_model.bodies;
    const bool meshes =
        std::any_of(bodies.begin(), bodies.end(), [](const Body& body) { return body.kind == Body::Kind::mesh; });
    if (with.scene.output.picture || (meets_bodies(params) && meshes)) return on;
    return meets_bodies(params) ? "all bodies have closed forms, and no picture is drawn"
                                : "no body is queried and no picture is drawn";
}

std::string picture(const FeatureCase& with, Params&)
{
    return with.scene.output.picture ? on : "output.picture is false";
}

std::string coarse_start(const FeatureCase& with, Params&) { return why_no_coarse_start(with.scene, with.model); }

std::string thin_bodies(const FeatureCase& with, Params&)
{
    const std::string reason = why_no_thin_bodies(with.scene, with.model);
    if (!reason.empty() || with.model.body_between) return reason;
    return "no body stands between the sides of a seam; they become thin where one does not close";
}

std::string sew(const FeatureCase& with, Params&) { return with.model.sews ? on : "there are no seams"; }

std::string body_motion(const FeatureCase& with, Params& params)
{
    const std::vector<Body>& bodies = with.model.cloth_model.bodies;
    if (!meets_bodies(params)) return "no body is queried";
    const auto moves = [](const Body& body) { return body.motion && body.motion->end() > 0; };
    return std::any_of(bodies.begin(), bodies.end(), moves) ? on : "no body has keyframes or a sequence";
}

std::string pin_motion(const FeatureCase& with, Params&)
{
    return with.model.cloth_model.cloth.pin_motions.empty() ? "there is no [[pins.motion]]" : on;
}

// Sewing is listed among the phases where there is any.
#define FEATURE(name) \
    {                 \
        #name, name   \
    }
#define UNLISTED(name)     \
    {                      \
        #name, name, false \
    }
constexpr Feature features[] = {FEATURE(gravity),
                                FEATURE(membrane),
                                FEATURE(curved_membrane),
                                FEATURE(spring),
                                FEATURE(bending),
                                FEATURE(plate),
                                FEATURE(bending_hysteresis),
                                FEATURE(seam),
                                FEATURE(damping),
                                FEATURE(body_contact),
                                FEATURE(body_repulsion),
                                FEATURE(friction),
                                FEATURE(cloth_contact),
                                FEATURE(cloth_repulsion),
                                FEATURE(cloth_friction),
                                FEATURE(velocity_rule),
                                FEATURE(embree),
                                FEATURE(picture),
                                FEATURE(coarse_start),
                                FEATURE(thin_bodies),
                                UNLISTED(sew),
                                FEATURE(wind),
                                FEATURE(air_drag),
                                FEATURE(body_motion),
                                FEATURE(pin_motion)};
#undef FEATURE
#undef UNLISTED

template <class Kernels>
bool has_name(const Kernels& kernels, std::string_view name)
{
    return std::any_of(kernels.begin(), kernels.end(), [&](const auto& kernel) { return kernel.name == name; });
}

}  // namespace

std::span<const Feature> all_features() { return features; }

bool is_kernel(std::string_view feature)
{
    return has_name(all_terms(), feature) || has_name(all_velocity_filters(), feature);
}

std::string why_off(const FeatureCase& with, std::string_view feature, const Params& params)
{
    std::string reason;
    for (const Feature& row : features)
        if (row.name == feature) {
            Params unused = params;
            reason = row.decide(with, unused);
        }
    if (!reason.empty() || !is_kernel(feature)) return reason;
    const auto runs = [&](const auto& kernel) { return kernel.name == feature && kernel.is_active(params); };
    const bool active = std::any_of(all_terms().begin(), all_terms().end(), runs) ||
                        std::any_of(all_velocity_filters().begin(), all_velocity_filters().end(), runs);
    return active ? "" : "its strength is zero";
}

std::string why_no_thin_bodies(const Scene& scene, const SceneModel& model)
{
    const std::vector<Body>& bodies = model.cloth_model.bodies;
    if (!model.sews) return "there are no seams";
    if (!scene.contact.body) return "contact.body is false";
    if (std::none_of(bodies.begin(), bodies.end(), [](const Body& body) { return body.kind == Body::Kind::mesh; }))
        return "no body is a mesh";
    return scene.seams.thin == 0 ? "seams.thin is 0" : on;
}

Params phase_params(const Scene& scene, const SceneModel& model, bool sewing)
{
    Params params;
    for (const Feature& row : features)
        if (is_kernel(row.name)) row.decide({scene, model, sewing}, params);
    return params;
}

}  // namespace selvage
