#include "host/solver/contact/contact_hardness.hpp"
#include "validation/measure/crumpled_sheets.hpp"
#include "validation/unit/catch.hpp"

using namespace selvage;

namespace {

constexpr double gap = 0.002, stiffness = 1000;

Body box_at(double speed)
{
    Body body;
    body.mesh = box_mesh({0, 0, 0}, {0.1, 0.1, 0.1});
    if (speed > 0)
        body.motion = std::make_shared<BodyMotion>(
            std::vector<MotionKey>{{0, Vec3::Zero(), Vec3::Zero()}, {1, speed * Vec3::UnitX(), Vec3::Zero()}}, false,
            Vec3::Zero());
    return body;
}

}  // namespace

TEST_CASE("contact is as stiff as the weight of the cloth and the speed of the body ask, each where it is")
{
    Cloth cloth = grid_cloth(4, 4, 0.02);
    add_panel(cloth, grid_cloth(4, 4, 0.02), {0, 0, 0.01});
    cloth.panels[1].fabric = "heavy";
    FabricTable fabrics = test_fabrics();
    fabrics["heavy"] = fabrics.at("test");
    fabrics["heavy"].areal_density = 4 * fabrics.at("test").areal_density;
    const double heaviest = fabrics["heavy"].areal_density;
    const ContactHardness hardness = local_hardness(make_topology(cloth, true), cloth, fabrics,
                                                    {box_at(0), box_at(0.1), box_at(5)}, {0, 0, -9.81}, stiffness, gap);
    for (int v = 0; v < 16; ++v) CHECK(hardness.of_particle[std::size_t(v)] == Approx(0.25));
    for (int v = 16; v < 32; ++v) CHECK(hardness.of_particle[std::size_t(v)] == 1);
    // What a fast body may drive has to pass its speed on from layer to layer, as long as it comes near at all.
    for (int v = 0; v < 16; ++v) CHECK(hardness.of_pairs[std::size_t(v)] == Approx(0.25 * hardness.of_body[2]));
    Cloth far = cloth;
    for (Vec3& x : far.positions) x += Vec3(0, 30, 0);
    CHECK(local_hardness(make_topology(far, true), far, fabrics, {box_at(5)}, {0, 0, -9.81}, stiffness, gap).of_pairs ==
          hardness.of_particle);
    CHECK(hardness.of_body[0] == 1);
    CHECK(hardness.of_body[1] == 1);
    CHECK(hardness.of_body[2] == Approx(heaviest * 25 / (gap * stiffness)).epsilon(0.02));
}
