#pragma once
#include <map>
#include <string>
#include <vector>

#include "host/model/body.hpp"
#include "host/model/cloth.hpp"
#include "io/scene/fabric.hpp"

namespace selvage {

/// Fabrics in the order of the state's material table.
using FabricTable = std::map<std::string, Fabric>;

/// The data that all phases of a run share. The coarser cloths have the same panels, each at twice the edge length of
/// the next finer one.
struct ClothModel {
    Cloth cloth;
    std::vector<Cloth> coarser;               ///< From fine to coarse; may be empty.
    std::vector<Prolongation> prolongations;  ///< From coarser[k] to the next finer cloth.
    FabricTable fabrics;
    std::vector<Body> bodies;
};

}  // namespace selvage
