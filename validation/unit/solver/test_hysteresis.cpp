#include <algorithm>
#include <cmath>

#include "host/garment/sheet.hpp"
#include "host/model/cloth_model.hpp"
#include "host/scene/plan.hpp"
#include "host/solver/contact/anchors.hpp"
#include "host/solver/stepping/equilibrium.hpp"
#include "host/solver/terms/cloth_state.hpp"
#include "io/scene/read_scene.hpp"
#include "validation/measure/small_cloth.hpp"
#include "validation/unit/catch.hpp"

using namespace selvage;

namespace {

constexpr double loop_weft = 1.2e-3, loop_warp = 4.8e-4;  // 2HB [N]

FabricTable rubbing_fabric()
{
    FabricTable fabrics = test_fabrics();
    fabrics.at("test").hysteresis_weft = loop_weft;
    fabrics.at("test").hysteresis_warp = loop_warp;
    return fabrics;
}

Params hysteresis_alone()
{
    Params params;
    params.bending_hysteresis.scale = 1;
    return params;
}

const Term& hysteresis_term()
{
    for (const Term& term : all_terms())
        if (term.name == "bending_hysteresis") return term;
    throw std::logic_error("no such term");
}

Cloth strip(MeshFamily family)
{
    SheetScene sheet;
    sheet.width = 0.06;
    sheet.height = 0.045;
    sheet.resolution = 25;
    sheet.mesh_family = family;
    sheet.fabric = "test";
    sheet.center = Vec3::Zero();
    return make_sheet(sheet, "", "sheet[0]");
}

// A strip that is bent to cylinders along x (axis 0, weft) or y (axis 1, warp). Its only force is that of hysteresis.
class BentStrip {
public:
    BentStrip(const Cloth& cloth, int axis)
        : cloth_(cloth), axis_(axis), params_(hysteresis_alone()),
          state_(make_state(make_topology(cloth, true), cloth, rubbing_fabric(), params_, cloth.positions, {}))
    {
    }

    double energy(double curvature)
    {
        place(curvature);
        return hysteresis_term().energy(state_, params_);
    }

    /// Returns dE/dkappa divided by the area of the bent faces, that is, without the faces at the free ends [N].
    double moment(double curvature)
    {
        const double change = 1e-4;
        return (energy(curvature + change) - energy(curvature - change)) / (2 * change * bent_area());
    }

    /// Bends the strip from one curvature to another in short steps, and updates the anchors after each.
    void bend(double from, double to)
    {
        constexpr int steps = 20;
        for (int k = 1; k <= steps; ++k) {
            place(from + (to - from) * k / steps);
            settle_anchors(state_, params_);
        }
    }

private:
    void place(double curvature)
    {
        const int vs = state_.size.vertex_stride;
        for (int v = 0; v < state_.size.vertex_count; ++v) {
            const double way = cloth_.positions[v][axis_], angle = curvature * way;
            state_.pos[axis_ * vs + v] = curvature == 0 ? way : std::sin(angle) / curvature;
            state_.pos[2 * vs + v] = curvature == 0 ? 0 : 2 * std::pow(std::sin(0.5 * angle), 2) / curvature;
        }
    }

    double bent_area() const
    {
        double end = 0, total = 0;
        for (const Vec3& x : cloth_.positions) end = std::max(end, x[axis_]);
        for (const Face& f : cloth_.faces) {
            int at_end = 0;
            for (int v : f) at_end += std::abs(cloth_.positions[v][axis_]) > end - 1e-9;
            const Vec3 &x = cloth_.positions[f[0]], &y = cloth_.positions[f[1]], &z = cloth_.positions[f[2]];
            if (at_end < 2) total += 0.5 * (y - x).cross(z - x).norm();
        }
        return total;
    }

    const Cloth& cloth_;
    int axis_;
    Params params_;
    State state_;
};

// Returns the deflection of a clamped strip that remains after its weight has bent it and gravity is switched off [m].
double drop_that_stays(bool hysteresis)
{
    ClothModel model;
    model.cloth = grid_cloth(12, 3, 0.005);
    for (int v = 0; v < 36; ++v)
        if (v % 12 < 2) model.cloth.pinned.push_back(v);
    model.fabrics = test_fabrics();
    Fabric& fabric = model.fabrics.at("test");
    fabric.areal_density = 0.12;
    fabric.stretch_weft = fabric.stretch_warp = 300;
    fabric.stretch_coupling = 0;
    fabric.shear = 50;
    fabric.bending_weft = fabric.bending_warp = 1e-5;
    fabric.hysteresis_weft = fabric.hysteresis_warp = 3e-4;
    PhaseOptions options;
    options.params.gravity.acceleration_z = -9.81;
    options.params.membrane.scale = options.params.plate.scale = 1;
    options.params.bending_hysteresis.scale = hysteresis ? 1 : 0;
    Profile profile;
    Phase phase(model, options, nullptr, profile, model.cloth.positions, {});
    EquilibriumOptions equilibrium;
    equilibrium.tolerance = 1e-5;
    for (double gravity : {-9.81, 0.0}) {
        phase.params().gravity.acceleration_z = gravity;
        DrapeProgress progress;
        CHECK(drape_to_equilibrium(phase, equilibrium, progress, [](const StepEvent&) { return true; }) ==
              PhaseEnd::reached);
    }
    return -phase.positions()[23].z();
}

RunPlan plan_of(const std::vector<std::string>& overrides)
{
    const Scene scene = read_scene("builtin:hanging", overrides);
    return make_plan(scene, build_scene_model(scene));
}

bool allocates_anchors(const RunPlan& plan)
{
    return required_fields(plan.phases.back().params)[std::size_t(Field::hinge_anchor)];
}

}  // namespace

TEST_CASE("cloth bent to and fro has a hysteresis loop of the width 2HB on any mesh, along weft and warp")
{
    for (const MeshFamily family : {MeshFamily::alternating, MeshFamily::same_diagonal, MeshFamily::irregular})
        for (int axis : {0, 1}) {
            INFO(word_of(family) << " axis " << axis);
            const double width = axis == 0 ? loop_weft : loop_warp;
            const Cloth cloth = strip(family);
            BentStrip bent(cloth, axis);
            bent.bend(0, 100);
            bent.bend(100, 0);
            const double down = bent.moment(0);
            bent.bend(0, -100);
            bent.bend(-100, 0);
            const double up = bent.moment(0);
            CHECK(up - down == Approx(width).epsilon(0.02));
            CHECK(up == Approx(-down).epsilon(0.02));
            bent.bend(0, 100);
            bent.bend(100, 0);
            CHECK(bent.moment(0) == Approx(down).epsilon(1e-6));
        }
}

TEST_CASE("cloth bent by less than the stick curvature springs back to where it was")
{
    const Cloth cloth = strip(MeshFamily::irregular);
    BentStrip bent(cloth, 0);
    const double lent = bent.energy(1);
    CHECK(lent > 0);
    bent.bend(0, 1);
    bent.bend(1, 0);
    CHECK(bent.energy(0) <= 1e-12 * lent);
    bent.bend(0, 50);
    bent.bend(50, 0);
    CHECK(bent.energy(0) > lent);
}

TEST_CASE("a strip that its weight has bent keeps part of the bend only with hysteresis")
{
    CHECK(std::abs(drop_that_stays(false)) < 2e-5);
    CHECK(drop_that_stays(true) > 1e-3);
}

TEST_CASE("hysteresis takes no memory unless the scene enables it and a fabric has it", "[plan]")
{
    const std::string size = "sheet.resolution=9", fabric = "sheet.fabric=wool_suiting";
    const std::string asked = "bending.hysteresis=true";
    CHECK(allocates_anchors(plan_of({size, fabric, asked})));
    CHECK_FALSE(allocates_anchors(plan_of({size, fabric})));
    CHECK_FALSE(allocates_anchors(plan_of({size, "sheet.fabric=cotton", asked})));
    CHECK_FALSE(allocates_anchors(plan_of({size, fabric, asked, "bending.model=none"})));
    const auto told = [](const RunPlan& plan) {
        for (const auto& skipped : plan.skipped)
            if (skipped.name == "bending_hysteresis") return skipped.reason;
        return std::string();
    };
    CHECK(told(plan_of({size, fabric})) == "bending.hysteresis is false");
    CHECK(told(plan_of({size, "sheet.fabric=cotton", asked})).find("no fabric") != std::string::npos);
    CHECK(told(plan_of({size, fabric, asked})).empty());
}
