#pragma once
#include "host/solver/stepping/newton.hpp"

namespace selvage {

/// Energy of whichever in-plane model the phase runs [J]; bend springs are springs too and count here.
inline double in_plane_energy(const Newton& newton)
{
    return newton.energy_of("membrane") + newton.energy_of("curved_membrane") + newton.energy_of("spring");
}

/// Energy of whichever bending model the phase runs, hysteresis included and bend springs excepted [J].
inline double bending_energy(const Newton& newton)
{
    return newton.energy_of("bending") + newton.energy_of("plate") + newton.energy_of("bending_hysteresis");
}

}  // namespace selvage
