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

/// A free vertex between pinned ones in a stretched membrane. It oscillates out of the plane like a mass on a spring.
class Oscillator {
public:
    /// @param frequency  frequency of small motions [rad/s]; the mass is chosen to give it
    /// @param drag       drag force divided by mass and speed [1/s]
    /// @param start      initial height divided by the mesh's spacing; motions below 1e-4 are linear to 1e-7
    Oscillator(std::string_view integrator, double frequency, double drag, double start);

    void step(double dt);
    double height() const;  ///< Height divided by the initial one [1].
    double speed() const;   ///< Time derivative of height() [1/s].
    double energy();        ///< Kinetic energy plus the potential energy above that of the flat membrane [J].

private:
    double start_;
    ClothModel model_;
    Profile profile_;
    std::unique_ptr<Phase> phase_;
    std::unique_ptr<Integrator> integrator_;
    double rest_energy_ = 0;
};

/// The amplitude factor and frequency of a damped oscillation x_k, fitted to all its steps by
/// x_(k+1) = 2 a cos(w dt) x_k - a^2 x_(k-1).
struct StepFactor {
    double amplitude = 1;  ///< a.
    double frequency = 0;  ///< w [rad/s].
};
StepFactor fit_step_factor(const std::vector<double>& motion, double dt);

}  // namespace selvage
