#include <set>

#include "host/solver/contact/friction_memory.hpp"
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

std::set<PairKey> keys_within_gap(const CcdFilter& filter)
{
    std::set<PairKey> keys;
    for (const PairCandidate& pair : filter.within_gap()) keys.insert(key_of(pair));
    return keys;
}

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

TEST_CASE("what a filter lists and cuts does not depend on what it has searched before", "[ccd_filter]")
{
    Body box;
    box.mesh = box_mesh(Vec3(0.03, 0.03, -0.08 - 2 * gap), Vec3(0.05, 0.04, 0.08));
    for (const std::vector<Body>& bodies : {std::vector<Body>{}, {box}})
        for (unsigned seed : {1u, 2u}) {
            FilteredSheets walking(sheets_above_each_other(3, side, spacing, 1.5 * gap), gap, spacing, bodies);
            FilteredSheets fresh(walking.cloth, gap, spacing, bodies);
            std::mt19937 random(seed);
            std::uniform_real_distribution<double> uniform(-1, 1);
            std::size_t listed = 0;
            for (int k = 0; k < 30; ++k) {
                std::vector<Vec3> wanted = random_waves(walking.cloth, (k % 4) * gap, spacing * side, random);
                const double from = spacing * side * uniform(random);
                for (std::size_t v = 0; v < wanted.size(); ++v)
                    if (k % 3 && walking.cloth.panel_coordinates[v].x() < from) wanted[v] *= 0.01;
                fresh.filter.forget();
                std::vector<real> one = as_planes(wanted, walking.stride()), other = one;
                walking.filter.filter_step(walking.state.pos, one, walking.stride(), walking.bodies(), k % 5 == 0);
                fresh.filter.filter_step(fresh.state.pos, other, fresh.stride(), fresh.bodies(), k % 5 == 0);
                CHECK((one == other));
                const std::set<PairKey> pairs = keys_within_gap(walking.filter);
                CHECK((pairs == keys_within_gap(fresh.filter)));
                listed += pairs.size();
                for (FilteredSheets* sheets : {&walking, &fresh})
                    for (std::size_t i = 0; i < one.size(); ++i) sheets->state.pos[i] += one[i];
            }
            CHECK(listed > 0);
            CHECK(walking.filter.counts().shortened > 0);
            CHECK(walking.filter.searches().partial.searches > 0);
            CHECK(walking.filter.searches().whole.searches < fresh.filter.searches().whole.searches);
        }
}
