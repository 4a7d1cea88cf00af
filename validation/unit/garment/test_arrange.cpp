#include "host/styles/arrange.hpp"

#include "host/styles/panel_parts.hpp"
#include "validation/unit/catch.hpp"

using namespace selvage;

namespace {

void reads(const std::string& name, GarmentPart part, int side, int face, int order = -1)
{
    INFO(name);
    const std::optional<PanelRole> role = panel_role(name);
    REQUIRE(role);
    CHECK(role->part == part);
    CHECK(role->side == side);
    CHECK(role->face == face);
    CHECK(role->order == order);
}

}  // namespace

TEST_CASE("names of panels tell part, side and face in the spellings that are in use")
{
    reads("left_ftorso", GarmentPart::torso, 1, 1);
    reads("right_btorso", GarmentPart::torso, -1, -1);
    reads("left_sleeve_b", GarmentPart::sleeve, 1, -1);
    reads("ins_skirt_front_3", GarmentPart::skirt, 0, 1, 3);
    reads("pant_f_r", GarmentPart::leg, -1, 1);
    reads("pant_l_cuff_b", GarmentPart::cuff, 1, -1);
    reads("wb_front", GarmentPart::waistband, 0, 1);
    reads("lfsleeve", GarmentPart::sleeve, 1, 1);
    reads("Rhood", GarmentPart::hood, -1, 0);
    reads("LeftSleeve", GarmentPart::sleeve, 1, 0);
    reads("back", GarmentPart::torso, 0, -1);
    reads("Trousers Back Left", GarmentPart::leg, 1, -1);
    CHECK_FALSE(panel_role("A17"));
    CHECK_FALSE(panel_role("panel_3"));
    CHECK_FALSE(panel_role("blouson"));
}

TEST_CASE("a pattern has no places if all its panels are moved and turned alike")
{
    Pattern pattern;
    pattern.panels.resize(2);
    CHECK(is_unplaced(pattern));
    pattern.panels[1].translation = Vec3(0, 0, 0.1);
    CHECK_FALSE(is_unplaced(pattern));
    pattern.panels.resize(1);
    CHECK_FALSE(is_unplaced(pattern));
}
