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

/// What all phases of a run share. The coarser cloths are the same panels at twice the edge length, and so on.
struct ClothModel {
    Cloth cloth;
    std::vector<Cloth> coarser;       ///< Finest of them first; may be empty.
    std::vector<Transfer> transfers;  ///< From coarser[k] to the next finer cloth.
    FabricTable fabrics;
    std::vector<Body> bodies;
};

}  // namespace selvage
