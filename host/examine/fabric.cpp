#include "host/examine/fabric.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace selvage {
namespace {

struct FabricTuning {
    // Mass over volume [kg/m^3]: fleece has 50, glass as a solid 2600. Beyond these lies no cloth.
    static constexpr double lightest = 5, heaviest = 4000;
    // Thickness of an elastic plate of the fabric's rigidity and stretch stiffness, over the fabric's own [1] and in
    // itself [m]: of the presets 4 and 1.2 mm at most.
    static constexpr double thick_plate = 20, thick_plate_m = 0.01;
};

InputPlace key_of(InputPlace place, const char* name)
{
    place.key += std::string(".") + name;
    return place;
}

}  // namespace

std::vector<Finding> examine_fabric(const Fabric& fabric, const InputPlace& place)
{
    std::vector<Finding> findings;
    const double density = fabric.areal_density / fabric.thickness;
    if (density < FabricTuning::lightest || density > FabricTuning::heaviest)
        findings.push_back({"fabric", key_of(place, "areal_density"),
                            fmt::format("{:.3g} kg/m^2 in a thickness of {:.3g} m is {:.3g} kg/m^3, where cloth has 50 "
                                        "to 1500",
                                        fabric.areal_density, fabric.thickness, density),
                            "check the units of `areal_density` (kg/m^2) and `thickness` (m)"});
    if (fabric.shear_curve.empty() && fabric.shear <= 0)
        findings.push_back({"fabric", key_of(place, "shear"),
                            "no stiffness in shear: the cloth collapses along its bias",
                            "give it some, woven cloth has 10 to 100 N/m"});
    const double rigidity = std::max(fabric.bending_weft, fabric.bending_warp);
    const double plate = std::sqrt(12 * rigidity / std::max(fabric.stretch_weft, fabric.stretch_warp));
    if (plate > FabricTuning::thick_plate_m && plate > FabricTuning::thick_plate * fabric.thickness)
        findings.push_back({"fabric", key_of(place, "bending_weft"),
                            fmt::format("a rigidity of {:.3g} N m is that of a plate {:.2g} mm thick of the fabric's "
                                        "stretch stiffness",
                                        rigidity, 1000 * plate),
                            "check its unit: 1 gf cm^2/cm, as KES-FB2 prints it, is 9.81e-5 N m", Severity::note});
    if (rigidity <= 0)
        findings.push_back({"fabric",
                            key_of(place, "bending_weft"),
                            "no bending rigidity: folds are as fine as the mesh",
                            {},
                            Severity::note});
    return findings;
}

}  // namespace selvage
