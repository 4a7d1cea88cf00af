#include "validation/measure/oscillator.hpp"

#include <cmath>

#include <Eigen/Dense>

#include "host/model/cloth_model.hpp"
#include "validation/measure/specimen.hpp"

namespace selvage {
namespace {

constexpr int middle = 4;                                     // index of the free one of nine vertices
constexpr double spacing = 10, stiffness = 1, stretch = 1.1;  // [m], [N/m], [1]

ClothModel small_membrane(double drag)
{
    ClothModel model;
    model.cloth = flat_rectangle(MeshFamily::alternating, 2 * spacing, 2 * spacing, 3);
    for (int v = 0; v < 9; ++v) {
        model.cloth.positions[v] *= stretch;
        if (v != middle) model.cloth.pinned.push_back(v);
    }
    Fabric fabric = isotropic_fabric(stiffness, 0, 0, 1);
    fabric.damping = drag;
    model.fabrics = {{specimen_fabric, fabric}};
    return model;
}

}  // namespace

NewtonOptions exact_steps()
{
    NewtonOptions newton;
    newton.max_iterations = 50;
    newton.tolerance = 1e-13;
    newton.linear_tolerance = 1e-8;
    newton.full_stiffness = true;
    return newton;
}

Oscillator::Oscillator(std::string_view integrator, double frequency, double drag, double start)
    : start_(start * spacing), model_(small_membrane(drag))
{
    PhaseOptions options;
    options.params.membrane.scale = 1;
    options.params.damping.scale = drag > 0;
    phase_ = std::make_unique<Phase>(model_, options, nullptr, profile_, model_.cloth.positions, std::vector<Vec3>());
    State& state = phase_->state();
    const int z = 2 * state.size.vertex_stride + middle;
    rest_energy_ = phase_->system().potential_energy();
    state.pos[z] = 1e-5 * spacing;
    const double spring = -phase_->system().static_force()[z] / state.pos[z];
    state.mass[middle] = spring / (frequency * frequency);
    state.inv_mass[middle] = 1 / state.mass[middle];
    if (drag > 0) state.drag[middle] = drag * state.mass[middle];
    state.pos[z] = start_;
    integrator_ = make_integrator(integrator, *phase_);
}

void Oscillator::step(double dt) { integrator_->step(dt, exact_steps()); }

double Oscillator::height() const
{
    return phase_->state().pos[2 * phase_->state().size.vertex_stride + middle] / start_;
}

double Oscillator::speed() const
{
    return phase_->state().vel[2 * phase_->state().size.vertex_stride + middle] / start_;
}

double Oscillator::energy()
{
    return phase_->system().potential_energy() - rest_energy_ + phase_->system().kinetic_energy();
}

StepFactor fit_step_factor(const std::vector<double>& motion, double dt)
{
    const int count = int(motion.size()) - 2;
    Eigen::MatrixX2d before(count, 2);
    Eigen::VectorXd after(count);
    for (int k = 0; k < count; ++k) {
        before.row(k) << motion[k + 1], -motion[k];
        after[k] = motion[k + 2];
    }
    const Eigen::Vector2d fit = before.colPivHouseholderQr().solve(after);
    const double amplitude = std::sqrt(fit[1]);
    return {amplitude, std::acos(fit[0] / (2 * amplitude)) / dt};
}

}  // namespace selvage
