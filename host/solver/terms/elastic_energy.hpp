#pragma once
#include "host/solver/terms/active_terms.hpp"

namespace selvage {

/// Energy of whichever in-plane model is active [J]; bend springs are springs too and count here.
inline double in_plane_energy(const ActiveTerms& terms)
{
    return terms.energy_of("membrane") + terms.energy_of("curved_membrane") + terms.energy_of("spring");
}

/// Energy of whichever bending model is active, hysteresis included and bend springs excepted [J].
inline double bending_energy(const ActiveTerms& terms)
{
    return terms.energy_of("bending") + terms.energy_of("plate") + terms.energy_of("bending_hysteresis");
}

}  // namespace selvage
