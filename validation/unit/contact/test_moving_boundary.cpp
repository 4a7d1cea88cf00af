#include "host/solver/contact/moving_boundary.hpp"
#include "validation/unit/catch.hpp"
#include "validation/unit/contact/small_stack.hpp"

using namespace selvage;

namespace {

constexpr double spacing = 0.02, gap = 0.003;
constexpr int side = 6, sheet_size = side * side;

const auto nobody_follows = [](std::vector<real>&) {};

// A box under a sheet that rises by a length within a second.
std::vector<Body> rising_box(double distance, double length)
{
    Body box;
    box.mesh = box_mesh(Vec3(-0.05, -0.05, -0.1 - distance), Vec3(0.2, 0.2, 0.1));
    box.motion = std::make_shared<BodyMotion>(std::vector<MotionKey>{{}, {1, Vec3(0, 0, length), Vec3::Zero()}}, false,
                                              Vec3::Zero());
    return {box};
}

double top_of(const MovingBoundary& boundary)
{
    double top = boundary.corners().corners.front().z();
    for (const Vec3& corner : boundary.corners().corners) top = std::max(top, corner.z());
    return top;
}

void hold(State& state, int first, int count) { std::fill_n(state.inv_mass.begin() + first, count, 0); }

}  // namespace

TEST_CASE("a body stops where held cloth is in its way, and what is told of its way is how far it has come",
          "[moving_boundary]")
{
    const double distance = 2 * gap, length = 8 * gap;
    const std::vector<Body> box = rising_box(distance, length);
    FilteredSheets sheet(grid_cloth(side, side, spacing), gap, spacing, box);
    hold(sheet.state, 0, sheet_size);
    const std::vector<real> start = sheet.state.pos;
    MovingBoundary boundary(box);
    double told = -1;
    boundary.set_carry([&](State&, double part) { told = part; });
    boundary.set_targets({}, 1);
    CHECK(boundary.is_pending());
    boundary.advance(sheet.state, sheet.filter, nobody_follows);
    CHECK(boundary.is_pending());
    CHECK(sheet.state.pos == start);
    const double least = least_distance(gap, sheet.gaps.largest_of_bodies(), ContactTuning::held_kept);
    CHECK(-top_of(boundary) >= least);
    CHECK(-top_of(boundary) <= least + 0.02 * (distance - least));
    CHECK(told * length == Approx(distance + top_of(boundary)));  // it rises at a steady speed
    for (std::size_t k = 0; k < sheet.corners.size(); ++k)
        CHECK(sheet.state.body_point[2 * sheet.state.size.body_point_stride + k] == boundary.corners().corners[k].z());
}

TEST_CASE("free cloth that a body comes towards goes along with it", "[moving_boundary]")
{
    const double distance = 0.5 * gap, length = 8 * gap;
    const std::vector<Body> box = rising_box(distance, length);
    FilteredSheets sheet(grid_cloth(side, side, spacing), gap, spacing, box);
    const std::vector<real> start = sheet.state.pos;
    MovingBoundary boundary(box);
    boundary.set_targets({}, 1);
    boundary.advance(sheet.state, sheet.filter, nobody_follows);
    CHECK_FALSE(boundary.is_pending());
    CHECK(top_of(boundary) == Approx(length - distance));
    const int plane = 2 * sheet.stride();
    for (int v = 0; v < sheet_size; ++v) CHECK(sheet.state.pos[plane + v] - start[plane + v] == Approx(length));
}

TEST_CASE("a body that goes away leaves cloth behind unless friction holds it", "[moving_boundary]")
{
    const std::vector<Body> box = rising_box(0.5 * gap, -8 * gap);
    for (bool held : {false, true}) {
        FilteredSheets sheet(grid_cloth(side, side, spacing), gap, spacing, box);
        sheet.state.friction_limit.assign(std::size_t(sheet.stride()), held ? 1 : 0);
        const real start = sheet.state.pos[2 * sheet.stride()];
        MovingBoundary boundary(box);
        boundary.set_targets({}, 1);
        boundary.advance(sheet.state, sheet.filter, nobody_follows);
        CHECK_FALSE(boundary.is_pending());
        CHECK(sheet.state.pos[2 * sheet.stride()] - start == Approx(held ? -8 * gap : 0).margin(1e-12));
    }
}

TEST_CASE("pins that nothing stops come exactly where they are to be, and stop where held cloth is in the way",
          "[moving_boundary]")
{
    FilteredSheets sheets(sheets_above_each_other(2, side, spacing, 2 * gap), gap, spacing);
    hold(sheets.state, 0, 2 * sheet_size);
    MovingBoundary boundary({});
    const auto targets = [&](double by) {
        std::vector<MovingBoundary::PinTarget> result;
        for (int v = sheet_size; v < 2 * sheet_size; ++v)
            result.push_back({v, sheets.cloth.positions[v] + Vec3(0.1 * by, 0, by)});
        return result;
    };
    boundary.set_targets(targets(0.7 * gap), 1);
    boundary.advance(sheets.state, sheets.filter, nobody_follows);
    CHECK_FALSE(boundary.is_pending());
    for (const auto& [particle, target] : targets(0.7 * gap))
        for (int c = 0; c < 3; ++c) CHECK(sheets.state.pos[c * sheets.stride() + particle] == target[c]);

    boundary.set_targets(targets(-10 * gap), 2);
    boundary.advance(sheets.state, sheets.filter, nobody_follows);
    CHECK(boundary.is_pending());
    const double height = sheets.state.pos[2 * sheets.stride() + sheet_size];
    CHECK(height >= least_distance(gap, gap, ContactTuning::held_kept));
    CHECK(height < 2.7 * gap);
}

TEST_CASE("what follows pins is left behind where it would hit something, so that pins are not stopped by it",
          "[moving_boundary]")
{
    FilteredSheets sheets(sheets_above_each_other(2, side, spacing, 0.02 * gap), gap, spacing);
    const int pin = 2 * sheet_size - 1;
    hold(sheets.state, pin, 1);
    MovingBoundary boundary({});
    const double rise = 2 * gap;
    boundary.set_targets({{pin, sheets.cloth.positions[pin] + Vec3(0, 0, rise)}}, 1);
    const int plane = 2 * sheets.stride();
    const auto first_dips = [&](std::vector<real>& displacement) { displacement[plane + sheet_size] = -rise; };
    const std::vector<real> start = sheets.state.pos;
    boundary.advance(sheets.state, sheets.filter, first_dips);
    CHECK(sheets.state.pos[plane + pin] - start[plane + pin] == Approx(ContactTuning::most_ahead * rise));
    CHECK(sheets.state.pos[plane + sheet_size] > 0);
}

TEST_CASE("bodies that are placed are where their motion has them, whatever is in the way", "[moving_boundary]")
{
    const std::vector<Body> box = rising_box(2 * gap, 8 * gap);
    FilteredSheets sheet(grid_cloth(side, side, spacing), gap, spacing, box);
    MovingBoundary boundary(box);
    const int version = boundary.corners().version;
    boundary.place_bodies(sheet.state, 0.5);
    CHECK_FALSE(boundary.is_pending());
    CHECK(boundary.corners().version != version);
    CHECK(top_of(boundary) == Approx(2 * gap));
}
