#include "host/run/garment_sewing.hpp"

#include <utility>

#include "host/collision/thin_body.hpp"
#include "host/parallel/trace.hpp"

namespace selvage {
namespace {

// Simulated time in which a body grows [s]. Twice as long takes as long to compute and ends no better: it is the way
// that takes the time.
constexpr double growing_time = 0.5;

// How many times stiffer contact is meanwhile. Bodies that grow press on cloth far harder than its weight does: at 1
// tight cloth lay so near to them that they could only grow in tiny steps (a tee that has to stretch by 20 % took 22 s,
// at 10 and at 100 it took 4 s).
constexpr double contact_while_growing = 30;

ClothModel model_of_sewing(const ClothModel& model)
{
    ClothModel result = model;
    result.cloth.pin_motions.clear();  // what moves in the scene waits for the garment
    return result;
}

}  // namespace

GarmentSewing::GarmentSewing(const SceneModel& model, const ClothSettings& settings, SewingProgress& progress,
                             Profile& profile, std::unique_ptr<Phase>& phase, std::function<void()> remade,
                             std::function<bool()> stop)
    : options_(settings.sew), progress_(progress), whole_(model.cloth_model.bodies),
      model_(model_of_sewing(model.cloth_model)), cloth_{model_, settings.sewing,   nullptr,        profile,
                                                         phase,  std::move(remade), std::move(stop)}
{
    const TraceScope scope("thin_bodies");
    if (progress_.welded.empty()) {
        progress_.welded = coinciding_pairs(model_.cloth);
        progress_.on_thin = options_.thin_at_once && options_.thin > 0;
    }
    thin_ = thin_bodies(whole_, progress_.on_thin ? options_.thin : 0);
    meet(thin_);
}

void GarmentSewing::meet(std::vector<Body> bodies)
{
    cloth_.phase.reset();
    model_.bodies = std::move(bodies);
    if (!meets_bodies(cloth_.options.params)) return;
    query_.emplace(model_.bodies, cloth_reach(model_.cloth));
    cloth_.query = &*query_;
}

// The thin bodies on their way to what they are, and contact as it is then.
std::vector<Body> GarmentSewing::growing()
{
    Params& params = cloth_.options.params;
    for (double* stiffness : {&params.body_contact.stiffness, &params.body_repulsion.stiffness,
                              &params.cloth_contact.stiffness, &params.cloth_repulsion.stiffness})
        *stiffness *= contact_while_growing;
    return growing_bodies(thin_, whole_, progress_.grows_from, growing_time);
}

// Puts the cloth as it is among other bodies.
void GarmentSewing::go_on_among(std::vector<Body> bodies)
{
    const std::vector<Vec3> positions = cloth_.phase->positions(), velocities = cloth_.phase->velocities();
    const Clock clock = cloth_.phase->system().clock();
    progress_.steps = {};
    meet(std::move(bodies));
    remake_phase(cloth_, options_, progress_, positions, velocities, clock);
}

void GarmentSewing::start()
{
    if (progress_.on_thin && progress_.grows_from >= 0) meet(growing());
    remake_phase(cloth_, options_, progress_, model_.cloth.positions, {}, {});
}

PhaseEnd GarmentSewing::run(const AfterStep& after_step)
{
    if (progress_.grows_from < 0) {
        PhaseEnd end = close_seams(cloth_, options_, progress_, after_step);
        if (end == PhaseEnd::time_limit && options_.thin > 0 && !progress_.on_thin) {
            progress_.on_thin = true;
            progress_.failures = progress_.harder = progress_.looks_in_vain = 0;
            thin_ = thin_bodies(whole_, options_.thin);
            go_on_among(thin_);
            end = close_seams(cloth_, options_, progress_, after_step);
        }
        if (end == PhaseEnd::stopped) return end;
        progress_.grows_from = cloth_.phase->system().clock().time;
        if (progress_.on_thin) go_on_among(growing());
    }
    const PhaseEnd end = let_bodies_grow(cloth_, options_, progress_, after_step);
    // Where cloth is in the way of a body, draping lets it out of it.
    return end == PhaseEnd::stopped ? end : PhaseEnd::reached;
}

}  // namespace selvage
