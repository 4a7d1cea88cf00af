#pragma once

// Every integrator, declared once: the scene's choices and the program's table of schemes come from this list. Each
// has its own file in host/solver/stepping/integrators, of its name, with a function make_NAME_integrator.
//     INTEGRATOR(name, word, order, is_explicit, error_power, summary)
//         word  as solver.integrator has it
#define INTEGRATORS(INTEGRATOR)                                                                                        \
    INTEGRATOR(implicit_euler, "implicit_euler", 1, false, 2, "first order, damps every motion, any step")             \
    INTEGRATOR(bdf2, "bdf2", 2, false, 3, "second order, damps fast motions, any step")                                \
    INTEGRATOR(implicit_midpoint, "implicit_midpoint", 2, false, 3, "second order, keeps the energy of small motions") \
    INTEGRATOR(symplectic_euler, "symplectic_euler", 1, true, 0, "first order, bounded energy")                        \
    INTEGRATOR(central_difference, "central_difference", 2, true, 0, "second order, drag taken implicitly")            \
    INTEGRATOR(velocity_verlet, "velocity_verlet", 2, true, 3, "second order, bounded energy")                         \
    INTEGRATOR(rk4, "rk4", 4, true, 4, "fourth order, four force evaluations")                                         \
    INTEGRATOR(quasistatic, "static", 0, false, 0, "no motion: straight to the shape at rest")
