#pragma once
#include <memory>
#include <string_view>
#include <vector>

#include "host/model/cloth_model.hpp"
#include "host/solver/stepping/integrator.hpp"
#include "host/solver/stepping/phase.hpp"

namespace selvage {

/// Options with which the implicit schemes solve their steps to rounding error.
NewtonOptions exact_steps();

/// A vertex between held ones in a stretched membrane: it swings out of the plane as a mass on a spring.
class Oscillator {
public:
    /// @param frequency  of small motions [rad/s]; the mass is chosen for it
    /// @param drag       force over mass and speed [1/s]
    /// @param start      height at the start over the mesh's spacing; motions below 1e-4 are linear to 1e-7
    Oscillator(std::string_view integrator, double frequency, double drag, double start);

    void step(double dt);
    double height() const;  ///< Over that at the start [1].
    double speed() const;   ///< Of height() [1/s].
    double energy();        ///< Above that of the flat membrane, plus the kinetic one [J].

private:
    double start_;
    ClothModel model_;
    Profile profile_;
    std::unique_ptr<Phase> phase_;
    std::unique_ptr<Integrator> integrator_;
    double rest_energy_ = 0;
};

/// How a motion x_k changes from step to step: x_(k+1) = 2 a cos(w dt) x_k - a^2 x_(k-1), fitted to all of them.
struct StepFactor {
    double amplitude = 1;  ///< a.
    double frequency = 0;  ///< w [rad/s].
};
StepFactor fit_step_factor(const std::vector<double>& motion, double dt);

}  // namespace selvage
