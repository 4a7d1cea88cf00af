#pragma once

namespace selvage {

/// What the energies of a cloth are summed by; kernels/terms.h gives each term its family. Terms of damping have none,
/// and moving air is no potential: what its terms sum up serves single steps only.
enum class EnergyFamily { external, membrane, bending, seam, damping, air, contact, friction };

/// Energies of a whole cloth by family [J].
struct Energies {
    double gravity = 0;
    double membrane = 0;  ///< Of faces and springs; bend springs are springs too and count here.
    double bending = 0;   ///< Of hinges, hysteresis included.
    double seam = 0;
    double contact = 0;  ///< Of the cloth with bodies and with itself, with what friction stores in its anchors.
    double kinetic = 0;
};

}  // namespace selvage
