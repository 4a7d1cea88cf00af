#pragma once
#include <limits>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "host/solver/stepping/newton.hpp"

namespace selvage {

class Phase;

/// What is known of a scheme without running it.
struct IntegratorInfo {
    std::string_view name;  ///< As in solver.integrator.
    std::string_view summary;
    int order = 0;  ///< Of the error at a given time in the step; 0: not a motion in time.
    bool is_explicit = false;
    int error_power = 0;  ///< The estimated error of one step goes with this power of it; 0: no estimate.

    bool has_error_estimate() const { return error_power > 0; }
};

/// All integrators; the first is the default.
std::span<const IntegratorInfo> integrators();

/// An array that an integrator takes from one step to the next.
struct HistoryArray {
    std::string_view name;  ///< Unique within the integrator.
    std::vector<real>* values;
};

/// Moves the cloth of one phase through time.
class Integrator {
public:
    virtual ~Integrator() = default;
    virtual const IntegratorInfo& info() const = 0;
    /// state.pos and state.vel move from t to t + dt; pinned vertices stay, friction settles.
    /// @param dt  [s], > 0   @param options  for the implicit schemes
    virtual NewtonReport step(double dt, const NewtonOptions& options) = 0;
    /// Forgets what earlier steps left: at the start, and when the state has been changed from outside.
    virtual void restart() {}
    /// Forgets what no longer holds since a velocity filter has moved the state a little after a step.
    virtual void displaced() { restart(); }
    /// What besides the state a step depends on, for retries and checkpoints; the sizes never change.
    virtual std::vector<HistoryArray> history() { return {}; }
    /// Largest error of a vertex that the last step has made, to leading order [m].
    virtual double error_estimate() const { return 0; }
    /// True if steps that are too long may add energy: such a step is then refused.
    virtual bool may_gain_energy() const { return info().is_explicit; }
    /// Longest step at which small motions stay bounded at the present state [s]; infinite: any.
    virtual double stable_step() { return std::numeric_limits<double>::infinity(); }
};

/// @throws InputError naming the nearest integrator
std::unique_ptr<Integrator> make_integrator(std::string_view name, Phase& phase);

}  // namespace selvage
