#pragma once
#include <functional>
#include <memory>
#include <optional>

#include "host/scene/run_settings.hpp"
#include "host/scene/scene_model.hpp"
#include "host/solver/stepping/sewing.hpp"

namespace selvage {

/// A garment while it is sewn: seams are closed on bodies that are thin and stand still, then the bodies grow to their
/// size and push the garment out. Bodies that no mesh describes keep their size.
class GarmentSewing {
public:
    /// @param progress  where sewing stands, of a resumed run as well   @param phase  is made here, again and again
    /// @param remade    called whenever the phase is another one   @param stop  asked within steps
    /// All references must outlive this object.
    GarmentSewing(const SceneModel& model, const ClothSettings& settings, SewingProgress& progress, Profile& profile,
                  std::unique_ptr<Phase>& phase, std::function<void()> remade, std::function<bool()> stop);

    /// Makes the phase as it is at the start of sewing, or what a checkpoint is to be put into.
    void start();
    /// @returns reached: all is done, though seams may have been given up; or stopped
    PhaseEnd run(const AfterStep& after_step);
    /// The bodies as the garment meets them, with their motion.
    const std::vector<Body>& bodies() const { return model_.bodies; }

private:
    void meet(std::vector<Body> bodies);
    std::vector<Body> growing();
    void go_on_among(std::vector<Body> bodies);

    const SewingOptions& options_;
    SewingProgress& progress_;
    const std::vector<Body>& whole_;
    std::vector<Body> thin_;
    ClothModel model_;
    std::optional<BodyQuery> query_;
    SewnCloth cloth_;
};

}  // namespace selvage
