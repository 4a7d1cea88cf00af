#pragma once
#include "host/solver/state/vectors.hpp"
#include "host/solver/stepping/integrator.hpp"
#include "host/solver/stepping/phase.hpp"

namespace selvage {

/// What the explicit schemes share: accelerations, friction, and a stability limit that is kept up to date.
class ExplicitScheme : public Integrator {
public:
    ExplicitScheme(Phase& phase, const IntegratorInfo& info) : phase_(phase), info_(info) {}
    const IntegratorInfo& info() const final { return info_; }
    NewtonReport step(double dt, const NewtonOptions& options) final;
    void restart() final;
    void displaced() override {}
    std::vector<HistoryArray> history() override { return {{"stability_watch", &watch_}}; }
    /// Estimated anew after some steps, and when many vertices have come into contact or left it.
    double stable_step() final;

protected:
    /// Moves pos and vel; pinned vertices must stay, which they do when they have no velocity and no acceleration.
    virtual void move(double dt) = 0;
    /// Longest stable step [s]. @param frequency  of the fastest mode [rad/s]   @param drag_rate  drag per mass [1/s]
    virtual double limit(double frequency, double drag_rate) const = 0;

    State& state() const { return phase_.state(); }
    int size() const { return int(phase_.state().pos.size()); }
    /// a = f(pos, vel) / m, zero at pinned vertices; looks up the bodies around pos.
    void accelerate(std::vector<real>& a);

    Phase& phase_;

private:
    int contacts() const { return phase_.contact() ? phase_.contact()->contact_count() : 0; }

    const IntegratorInfo& info_;
    /// The limit [s], 0 if unknown; steps since it was estimated; vertices in contact then, and now.
    std::vector<real> watch_{0, 0, 0, 0};
};

}  // namespace selvage
