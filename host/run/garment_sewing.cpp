#include "host/run/garment_sewing.hpp"

#include <utility>

#include "host/collision/thin_body.hpp"
#include "host/parallel/trace.hpp"

namespace selvage {
namespace {

// Simulated time in which a body grows [s]. Twice as long takes as long to compute and ends no better: it is the way
// that takes the time.
constexpr double growing_time = 0.5;

ClothModel model_of_sewing(const ClothModel& model)
{
    ClothModel result = model;
    result.cloth.pin_motions.clear();  // what moves in the scene waits for the garment
    return result;
}

}  // namespace

GarmentSewing::GarmentSewing(const SceneModel& model, const ClothSettings& settings, SewingProgress& progress,
                             Profile& profile, std::unique_ptr<Phase>& phase, std::function<void()> remade)
    : options_(settings.sew), progress_(progress), whole_(model.cloth_model.bodies),
      model_(model_of_sewing(model.cloth_model)), cloth_{model_,  settings.sewing, nullptr,
                                                         profile, phase,           std::move(remade)}
{
    const TraceScope scope("thin_bodies");
    thin_ = thin_bodies(whole_, options_.thin);
    if (progress_.welded.empty()) progress_.welded = coinciding_pairs(model_.cloth);
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

void GarmentSewing::grow_from(double start)
{
    if (options_.thin > 0) meet(growing_bodies(thin_, whole_, start, growing_time));
}

void GarmentSewing::start()
{
    if (progress_.grows_from >= 0) grow_from(progress_.grows_from);
    remake_phase(cloth_, options_, progress_, model_.cloth.positions, {}, {});
}

PhaseEnd GarmentSewing::run(const AfterStep& after_step)
{
    if (progress_.grows_from < 0) {
        const PhaseEnd end = close_seams(cloth_, options_, progress_, after_step);
        if (end == PhaseEnd::stopped) return end;
        const std::vector<Vec3> positions = cloth_.phase->positions(), velocities = cloth_.phase->velocities();
        const Clock clock = cloth_.phase->system().clock();
        progress_.grows_from = clock.time;
        progress_.steps = {};
        grow_from(clock.time);
        remake_phase(cloth_, options_, progress_, positions, velocities, clock);
    }
    return let_bodies_grow(cloth_, options_, progress_, after_step);
}

}  // namespace selvage
