#pragma once
#include "host/solver/stepping/integrator.hpp"

// Every integrator, declared once:
//     INTEGRATOR(name, order, is_explicit, error_power, summary)
#define INTEGRATORS(INTEGRATOR)                                                                   \
    INTEGRATOR(implicit_euler, 1, false, 2, "first order, damps every motion, any step")          \
    INTEGRATOR(bdf2, 2, false, 3, "second order, damps fast motions, any step")                   \
    INTEGRATOR(implicit_midpoint, 2, false, 3, "second order, keeps the energy of small motions") \
    INTEGRATOR(symplectic_euler, 1, true, 0, "first order, bounded energy")                       \
    INTEGRATOR(central_difference, 2, true, 0, "second order, drag taken implicitly")             \
    INTEGRATOR(velocity_verlet, 2, true, 3, "second order, bounded energy")                       \
    INTEGRATOR(rk4, 4, true, 4, "fourth order, four force evaluations")                           \
    INTEGRATOR(static, 0, false, 0, "no motion: straight to the shape at rest")

namespace selvage {

/// One function per integrator, each in the file of its name.
#define INTEGRATOR(name, order, is_explicit, error_power, summary) \
    std::unique_ptr<Integrator> make_##name##_integrator(Phase& phase, const IntegratorInfo& info);
INTEGRATORS(INTEGRATOR)
#undef INTEGRATOR

}  // namespace selvage
