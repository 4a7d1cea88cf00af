#include "host/solver/state/materials.hpp"

#include <limits>

#include "host/model/cloth_model.hpp"

namespace selvage {
namespace {

void fill_curve(const StressCurve& curve, real* to, int stride)
{
    const std::vector<double> energies = start_energies(curve);
    for (int range = 0; range < CURVE_RANGES; ++range) {
        real* numbers = to + std::size_t(CURVE_NUMBERS) * range * stride;
        numbers[0] = std::numeric_limits<real>::max();
        if (range >= int(curve.size())) continue;
        const CurveRange& r = curve[range];
        const real values[] = {r.start, energies[range], r.stress, r.slope, r.quadratic, r.cubic};
        static_assert(std::size(values) == CURVE_NUMBERS);
        for (int k = 0; k < CURVE_NUMBERS; ++k) numbers[std::size_t(k) * stride] = values[k];
    }
}

}  // namespace

void fill_materials(State& state, const FabricTable& fabrics)
{
    if (state.material_stretch.empty()) return;
    const int stride = state.size.material_stride;
    int row = 0;
    for (const auto& [name, fabric] : fabrics) {
        const double stretch[] = {fabric.stretch_weft, fabric.stretch_warp, fabric.stretch_coupling, fabric.shear};
        for (int k = 0; k < 4; ++k) state.material_stretch[k * stride + row] = stretch[k];
        int direction = 0;
        constexpr std::size_t numbers = CURVE_NUMBERS * CURVE_RANGES;
        for (const StressCurve& curve : membrane_curves(fabric))
            if (!state.material_curve.empty())
                fill_curve(curve, &state.material_curve[numbers * direction++ * stride + row], stride);
        ++row;
    }
}

}  // namespace selvage
