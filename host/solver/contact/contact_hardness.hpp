#pragma once
#include <vector>

#include "host/model/body.hpp"
#include "host/model/cloth_model.hpp"
#include "host/solver/state/topology.hpp"

namespace selvage {

/// How stiff contact is at each place, over the stiffness of its term [1]. Heavy cloth and fast bodies ask for more,
/// but only where they are. All lists are empty where contact is equally stiff everywhere.
struct ContactHardness {
    std::vector<double> of_particle;  ///< On bodies that are not fast, by the weight of its fabric.
    std::vector<double> of_body;      ///< By its highest speed, times that of the particle it is nearest to.
    /// In pairs, per particle: also by the fastest body that comes near its piece of cloth, which may drive all of it.
    std::vector<double> of_pairs;
};

/// @param down       gravity, of any length
/// @param stiffness  pressure scale of contact at the heaviest fabric, where no body is fast [Pa]
/// @param gap        at which contact with bodies sets in [m]
ContactHardness local_hardness(const Topology& topology, const Cloth& cloth, const FabricTable& fabrics,
                               const std::vector<Body>& bodies, const Vec3& down, double stiffness, double gap);

}  // namespace selvage
