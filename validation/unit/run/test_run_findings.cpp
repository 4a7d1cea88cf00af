#include <algorithm>
#include <limits>

#include "host/run/measure.hpp"
#include "host/run/run_findings.hpp"
#include "validation/measure/small_cloth.hpp"
#include "validation/unit/catch.hpp"

using namespace selvage;

namespace {

Body named(const std::string& name, Body::Kind kind)
{
    Body body;
    body.name = name;
    body.kind = kind;
    return body;
}

ClothModel worn_model()
{
    ClothModel model;
    model.cloth = grid_cloth(3, 3);
    model.bodies = {named("mannequin", Body::Kind::mesh), named("floor", Body::Kind::plane)};
    return model;
}

}  // namespace

TEST_CASE("a garment is lost once it has fallen by a fifth of its height, or touches no body that could wear it")
{
    const ClothModel model = worn_model();
    CHECK(find_lost_garment(model, {0.6, 0.05, {true, false}}).empty());
    CHECK(find_lost_garment(model, {0.6, 0.05, {true, true}}).empty());
    CHECK(find_lost_garment(model, {0.6, 0.1, {true, true}}).empty());
    CHECK(find_lost_garment(model, {0.6, 0.15, {true, true}}).size() == 1);

    const std::vector<Finding> slid = find_lost_garment(model, {0.6, 0.86, {true, true}});
    REQUIRE(slid.size() == 1);
    CHECK_THAT(describe(slid[0]),
               contains_text("0.86 m") && contains_text("0.60 m high") && contains_text("garment.translation"));

    const std::vector<Finding> beside = find_lost_garment(model, {0.6, 0.01, {false, true}});
    REQUIRE(beside.size() == 1);
    CHECK_THAT(describe(beside[0]), contains_text("`mannequin` nowhere"));

    ClothModel only_floor = model;
    only_floor.bodies.erase(only_floor.bodies.begin());
    CHECK(find_lost_garment(only_floor, {0.6, 0.86, {true}}).empty());
}

TEST_CASE("steps are long for a motion where one errs by more than three hundredths of the cloth's extent")
{
    const std::vector<Vec3> positions{{0, 0, 1}, {0.3, 0, 1}, {0, 0.4, 1}};
    CHECK(find_long_steps({}, positions).empty());
    CHECK(find_long_steps({.estimates = 3, .largest_error = 0.0149, .error_time = 0.1}, positions).empty());
    const std::vector<Finding> found =
        find_long_steps({.estimates = 3, .largest_error = 0.04, .error_time = 0.1}, positions);
    REQUIRE(found.size() == 1);
    CHECK_THAT(describe(found[0]), contains_text("40 mm, 8 %") && contains_text("0.1 s") && contains_text("adaptive"));
}

TEST_CASE("crossings at the end are told with their number and the first place, far away with the rounding there")
{
    const ClothModel model = worn_model();
    EndCrossings crossings;
    crossings.counted = true;
    crossings.positions = model.cloth.positions;
    CHECK(find_end_crossings(model, crossings).empty());

    crossings.self = {{0, 5}, {1, 6}};
    crossings.with_body = {{{2, 0}}, {}};
    const std::vector<Finding> found = find_end_crossings(model, crossings);
    REQUIRE(found.size() == 2);
    CHECK_THAT(describe(found[0]),
               contains_text("2 pairs") && contains_text("triangle 0 of `sheet`") && contains_text("selvage check"));
    CHECK_THAT(describe(found[1]), contains_text("`mannequin`") && contains_text("triangle 2"));

    for (Vec3& x : crossings.positions) x.x() += 1e6;
    CHECK_THAT(describe(find_end_crossings(model, crossings)[0]), contains_text("single precision"));
}

TEST_CASE("what was found before a run is told again where it explains the end")
{
    const std::vector<Finding> before{{"triangle", {}, "a sliver"},
                                      {"stitch", {}, "a crossed stitch"},
                                      {.kind = "unit", .place = {}, .text = "a note", .severity = Severity::note}};
    const auto kinds = [&](bool complete, const std::vector<Finding>& at_end) {
        std::string text;
        for (const Finding& finding : findings_that_mattered(before, complete, at_end)) text += finding.kind + " ";
        return text;
    };
    CHECK(kinds(true, {}).empty());
    CHECK(kinds(false, {}) == "triangle stitch ");
    CHECK(kinds(true, {{"self_intersection", {}, "at the end"}}) == "stitch ");
}

TEST_CASE("the largest stretch is found with its face, and only above a limit")
{
    const Cloth cloth = grid_cloth(5, 4);
    std::vector<Vec3> x = cloth.positions;
    x.back().x() += 0.05;  // of an edge of 0.1 m
    const std::vector<std::array<Vec2, 3>> rest = rest_corners(cloth);
    const StretchMeasure whole = measure_stretch(rest, outward_faces(cloth), x);
    const FaceStretch largest = largest_stretch(cloth, x, 0);
    CHECK(largest.stretch == Approx(whole.max).epsilon(1e-6));
    CHECK(largest.stretch > 0.4);
    REQUIRE(largest.face >= 0);
    const Face& face = cloth.faces[std::size_t(largest.face)];
    CHECK(std::count(face.begin(), face.end(), int(x.size()) - 1) == 1);
    CHECK(largest_stretch(cloth, x, largest.stretch).face == -1);
    CHECK(whole.max_face >= 0);
    x.assign(x.size(), Vec3::Constant(std::numeric_limits<double>::quiet_NaN()));
    CHECK(largest_stretch(cloth, x, 0).face == -1);
}
