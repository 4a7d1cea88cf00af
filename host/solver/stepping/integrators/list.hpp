#pragma once
#include "host/solver/stepping/integrator.hpp"
#include "io/integrators.hpp"

namespace selvage {

/// One function per integrator, each in the file of its name.
#define INTEGRATOR(name, word, order, is_explicit, error_power, summary) \
    std::unique_ptr<Integrator> make_##name##_integrator(Phase& phase, const IntegratorInfo& info);
INTEGRATORS(INTEGRATOR)
#undef INTEGRATOR

}  // namespace selvage
