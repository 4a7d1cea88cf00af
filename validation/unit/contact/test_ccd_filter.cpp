#include "validation/unit/catch.hpp"
#include "validation/unit/contact/small_stack.hpp"

using namespace selvage;

namespace {

constexpr double spacing = 0.02, gap = 0.003;
constexpr int side = 8;

// Two sheets, of which the upper one moves.
struct TwoSheets : FilteredSheets {
    explicit TwoSheets(double distance)
        : FilteredSheets(sheets_above_each_other(2, side, spacing, distance), gap, spacing)
    {
    }

    float free_fraction(const Vec3& by, bool held = false)
    {
        const std::vector<real> displacement = panel_displacement(1, by);
        const StraightStep step{state.pos, &displacement, stride(), bodies()};
        filter.refresh(step);
        return filter.free_fraction(step, held ? filter.held_margins() : filter.margins());
    }
};

}  // namespace

TEST_CASE("the free fraction of a step towards a sheet ends where the pairs keep their share of the gap",
          "[ccd_filter]")
{
    const double start = 2 * gap, length = 5 * gap;
    for (bool held : {false, true}) {
        const double left = start - length * TwoSheets(start).free_fraction(Vec3(0, 0, -length), held);
        const double least = least_distance(gap, gap, held ? ContactTuning::held_kept : ContactTuning::kept);
        CHECK(left >= least);
        CHECK(left <= least + 0.02 * (start - least));  // free_fraction stops so near its bound
    }
}

TEST_CASE("all of a step that meets nothing is free, and it is left as it is", "[ccd_filter]")
{
    TwoSheets sheets(2 * gap);
    for (const Vec3& by : {Vec3(0, 0, 0.5), Vec3(0.03, -0.02, 0), Vec3(0, 0, -0.5 * gap)}) {
        CHECK(sheets.free_fraction(by) == 1);
        for (bool uniform : {false, true}) {
            const std::vector<real> wanted = sheets.panel_displacement(1, by);
            std::vector<real> displacement = wanted;
            sheets.filter.filter_step(sheets.state.pos, displacement, sheets.stride(), sheets.bodies(), uniform);
            CHECK((displacement == wanted));  // the vectors are too long to print
        }
    }
    CHECK(sheets.filter.counts().shortened == 0);
}

TEST_CASE("only particles that would hit something are shortened unless all are to be", "[ccd_filter]")
{
    for (bool uniform : {false, true}) {
        TwoSheets sheets(2 * gap);
        std::vector<real> displacement = sheets.panel_displacement(1, Vec3(0, 0, -5 * gap));
        const int plane = 2 * sheets.stride();
        const int lifted = 2 * side * side - 1;  // a corner that goes the other way
        displacement[plane + lifted] = 5 * gap;
        sheets.filter.filter_step(sheets.state.pos, displacement, sheets.stride(), sheets.bodies(), uniform);
        if (!uniform) CHECK(displacement[plane + lifted] == 5 * gap);
        if (uniform) CHECK(displacement[plane + lifted] == Approx(-displacement[plane + side * side]));
        CHECK(std::abs(displacement[plane + side * side]) < 2 * gap);
        CHECK(std::abs(displacement[plane + side * side]) > gap);
        CHECK(sheets.filter.counts().shortened == 1);
    }
}

TEST_CASE("a step that has been taken is tested from where it began", "[ccd_filter]")
{
    TwoSheets sheets(2 * gap);
    for (double by : {-1.0, -3.0, -50.0, 50.0}) {  // near, through, far through, away; in gaps
        const std::vector<real> displacement = sheets.panel_displacement(1, Vec3(0, 0, by * gap));
        const bool free = sheets.filter.is_free({sheets.state.pos, &displacement, sheets.stride(), sheets.bodies()});
        CHECK(free == (by > -2));
    }
}

TEST_CASE("what is tangled may pass through the like, and nothing else may", "[ccd_filter]")
{
    TwoSheets sheets(2 * gap);
    const Vec3 through(0, 0, -5 * gap);
    std::fill(sheets.crossings.tangled.begin(), sheets.crossings.tangled.end() - side * side, 1);
    CHECK(sheets.free_fraction(through) < 1);
    std::fill(sheets.crossings.tangled.begin(), sheets.crossings.tangled.end(), 1);
    CHECK(sheets.free_fraction(through) == 1);
}

TEST_CASE("a step of a body is free up to the cloth in its way", "[ccd_filter]")
{
    Body box;
    box.mesh = box_mesh(Vec3(0.03, 0.03, -0.08 - 2 * gap), Vec3(0.05, 0.04, 0.08));
    FilteredSheets sheet(grid_cloth(side, side, spacing), gap, spacing, {box});
    const double length = 10 * gap;
    const std::vector<Vec3> rise(sheet.corners.size(), Vec3(0, 0, length));
    const std::vector<real> none(sheet.state.pos.size());
    const StraightStep step{sheet.state.pos, &none, sheet.stride(), {sheet.corners, &rise, 0}};
    sheet.filter.refresh(step);
    const double left = 2 * gap - length * sheet.filter.free_fraction(step, sheet.filter.margins());
    const double least = least_distance(gap, sheet.gaps.largest_of_bodies(), ContactTuning::kept);
    CHECK(left >= least);
    CHECK(left <= least + 0.02 * (2 * gap - least));
}
