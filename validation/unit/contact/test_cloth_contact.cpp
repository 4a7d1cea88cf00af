#include "host/mesh/self_intersections.hpp"
#include "host/model/body.hpp"
#include "host/model/cloth_model.hpp"
#include "host/solver/stepping/equilibrium.hpp"
#include "host/solver/stepping/phase.hpp"
#include "io/scene/fabric_table.hpp"
#include "validation/unit/catch.hpp"
#include "validation/unit/contact/small_stack.hpp"

using namespace selvage;

namespace {

constexpr double spacing = 0.02, gap = 0.003;
constexpr int side = 8;

// Panels with nothing but contact, which a test moves about.
struct Pile {
    Cloth cloth;
    std::vector<Body> bodies;
    Topology topology;
    Params params = contact_alone(gap);
    State state;
    ClothContact contact;

    explicit Pile(Cloth of, std::vector<Body> with = {})
        : cloth(std::move(of)), bodies(std::move(with)), topology(make_topology(cloth, false)),
          state(make_state(topology, cloth, test_fabrics(), params, cloth.positions, {})),
          contact(topology, cloth, bodies, ContactGaps(gap), particle_friction(topology, cloth, test_fabrics()))
    {
        contact.begin(state);
    }

    int stride() const { return state.size.vertex_stride; }
    std::vector<Vec3> points() const { return as_points(state.pos, stride(), state.size.vertex_count); }

    bool intersects(const std::vector<Vec3>& x) const
    {
        bool any = !self_intersections(x, cloth.faces).empty();
        for (const Body& body : bodies) any = any || !mutual_intersections(x, cloth.faces, body.mesh).empty();
        return any;
    }

    // Returns a move of the upper panels by a common displacement.
    std::vector<real> shift(const Vec3& way) const
    {
        std::vector<Vec3> move(cloth.positions.size(), Vec3::Zero());
        for (int v = cloth.panels[1].first_vertex; v < int(move.size()); ++v) move[v] = way;
        return as_planes(move, stride());
    }

    void add(const std::vector<real>& move)
    {
        for (std::size_t i = 0; i < move.size(); ++i) state.pos[i] += move[i];
    }
};

Cloth stack(int count, double distance) { return sheets_above_each_other(count, side, spacing, distance); }

// Makes large random moves, each shortened by the CCD step filter, and checks that the cloth does not intersect itself
// or a body on the way.
void hurl(Pile& pile, bool uniform, unsigned seed)
{
    INFO("seed " << seed << (uniform ? ", uniform" : ""));
    std::mt19937 random(seed);
    std::normal_distribution<double> noise(0, 0.004);
    const double size = spacing * (side - 1);
    double gone = 0;
    for (int k = 0; k < 12; ++k) {
        std::vector<Vec3> way = random_waves(pile.cloth, k % 3 ? 0.3 * size : 2 * size, size, random);
        for (Vec3& u : way) u += Vec3(noise(random), noise(random), noise(random));
        std::vector<real> move = as_planes(way, pile.stride());
        pile.contact.filter_step(pile.state, move, uniform);
        const std::vector<Vec3> from = pile.points(), cleared = as_points(move, pile.stride(), int(from.size()));
        for (double part : {0.2, 0.5, 0.8, 1.0}) {
            std::vector<Vec3> x = from;
            for (std::size_t v = 0; v < x.size(); ++v) x[v] += part * cleared[v];
            CHECK_FALSE(pile.intersects(x));
        }
        for (std::size_t v = 0; v < way.size(); ++v) {
            CHECK(cleared[v].norm() <= way[v].norm() * (1 + 1e-12));
            gone += cleared[v].norm() / double(way.size());
        }
        pile.add(move);
    }
    CHECK(gone > 0.5 * gap);
    CHECK(pile.contact.counts().shortened > 0);
    CHECK(pile.contact.counts().tangles == 0);
}

// What friction remembers of the pairs that are listed in the state.
FrictionMemory in_state(const State& s)
{
    FrictionMemory result;
    const int ps = s.size.pair_stride;
    for (int p = 0; p < s.size.pair_count; ++p) {
        if (s.pair_limit[p] == 0) continue;
        PairFriction friction{{s.pair_edges[p] == 1, {}}, {}, {}, {}, s.pair_limit[p]};
        for (int i = 0; i < 4; ++i) friction.pair.corner[i] = s.pair_vertex[i * ps + p];
        for (int i = 0; i < 4; ++i) friction.weight[i] = s.pair_held_weight[i * ps + p];
        for (int c = 0; c < 3; ++c) friction.normal[c] = s.pair_held_normal[c * ps + p];
        for (int c = 0; c < 3; ++c) friction.bristle[c] = s.pair_bristle[c * ps + p];
        result.push_back(friction);
    }
    return result;
}

// Lets a patch slide on an inclined, pinned sheet; instead of the sheet gravity is tilted. Returns the mean velocity of
// the patch [m/s].
Vec3 slide(double slope, double friction, double until)
{
    ClothModel model;
    model.cloth = grid_cloth(8, 5, spacing);
    for (int v = 0; v < int(model.cloth.positions.size()); ++v) model.cloth.pinned.push_back(v);
    add_panel(model.cloth, grid_cloth(3, 3, spacing), Vec3(0.013, 0.017, 0.9 * gap));
    model.fabrics["test"] = fabric_preset("cotton");
    model.fabrics["test"].friction = friction;
    PhaseOptions options;
    options.params = contact_alone(gap);
    options.params.membrane.scale = 1;
    options.params.plate.scale = 1;
    options.params.gravity.acceleration_x = 9.81 * std::sin(slope);
    options.params.gravity.acceleration_z = -9.81 * std::cos(slope);
    Profile profile;
    Phase phase(model, options, nullptr, profile, model.cloth.positions, {});
    const auto scheme = make_integrator("implicit_euler", phase);
    EquilibriumOptions limits;
    limits.step.longest = 0.002;
    limits.integrator = scheme.get();
    limits.step_tolerance = 1e-3;  // what steps leave moves the patch as well: 1e-2 of gravity is 0.2 mm/s here
    limits.newton_iterations = 40;
    DrapeProgress progress;
    drape_until(phase, limits, until, 1.0 / 60, progress, [](const StepEvent&) { return true; });
    Vec3 sum = Vec3::Zero();
    for (int v = 40; v < 49; ++v) sum += phase.velocities()[v] / 9;
    return sum;
}

}  // namespace

TEST_CASE("large moves, once filtered, never take cloth through itself", "[cloth_contact]")
{
    for (bool uniform : {false, true})
        for (unsigned seed : {1u, 2u}) {
            Pile sheet(grid_cloth(side, side, spacing)), sheets(stack(3, 1.5 * gap)), slit(slit_cloth(side, spacing));
            hurl(sheet, uniform, seed);
            hurl(sheets, uniform, seed);
            hurl(slit, uniform, seed);
        }
}

TEST_CASE("large moves, once filtered, never take cloth through a body's mesh", "[cloth_contact]")
{
    Body box;
    box.mesh = box_mesh(Vec3(0.05, 0.05, -0.06), Vec3(0.05, 0.04, 0.055));
    for (bool uniform : {false, true})
        for (unsigned seed : {4u, 5u}) {
            Pile pile(stack(2, 1.5 * gap), {box});
            hurl(pile, uniform, seed);
        }
}

TEST_CASE("pairs in contact are listed with their distance below the gap, and around their vertices", "[cloth_contact]")
{
    Pile pile(stack(2, 0.7 * gap));
    pile.contact.update(pile.state);
    const State& s = pile.state;
    REQUIRE(s.size.pair_count > 0);
    for (int p = 0; p < s.size.pair_count; ++p) {
        const double distance = pair_distance(pair_corners(s, p), s.pair_edges[p]);
        CHECK(distance >= 0.7 * gap * (1 - 1e-6));
        CHECK(distance < gap);
        CHECK(s.pair_gap[p] == gap);
        CHECK(s.pair_area[p] >= 0);
    }
    State listed = s;
    list_pair_slots(listed);
    for (int v = 0; v < s.size.vertex_count; ++v)
        for (int end : {v, s.size.vertex_stride + v}) CHECK(listed.pair_slots[end] == s.pair_slots[end]);
    for (int k = 0; k < 4 * s.size.pair_count; ++k) CHECK(listed.pair_slot[k] == s.pair_slot[k]);
    pile.add(pile.shift(Vec3(0, 0, gap)));
    pile.contact.update(pile.state);
    CHECK(pile.state.size.pair_count == 0);
}

TEST_CASE("the state has room for the slots of all pairs, however their number grows", "[cloth_contact]")
{
    for (int step : {1, 7, 40, 129}) {
        Pile pile(grid_cloth(3, 3, spacing));
        State& state = pile.state;
        for (int count = 1; count < 2000; count += step) {
            state.set_pairs(count);
            CHECK(state.pair_slot.size() >= 4 * std::size_t(count));
            CHECK(state.pair_vertex.size() >= 4 * std::size_t(state.size.pair_stride));
            CHECK(state.size.pair_stride >= count);
        }
    }
}

TEST_CASE("a move is clear only if the cloth does not pass through itself on the way from the old positions",
          "[cloth_contact]")
{
    Pile pile(stack(2, 2 * gap));
    const std::vector<real> from = pile.state.pos;
    for (double way :
         {-1.0, -3.0, -50.0, 50.0}) {  // in gaps: close to the panel below, through it, far through it, away
        pile.state.pos = from;
        pile.add(pile.shift(Vec3(0, 0, way * gap)));
        const std::vector<real> at = pile.state.pos;
        CHECK(pile.contact.is_clear_from(pile.state, from) == (way > -2));
        CHECK(pile.state.pos == at);
    }
}

TEST_CASE("a pair keeps its bristle while the cloth is elsewhere within a step", "[cloth_contact]")
{
    Pile pile(stack(3, 0.7 * gap));
    pile.contact.update(pile.state);
    pile.contact.settle(pile.state, pile.params);
    FrictionMemory memory = pile.contact.memory();
    REQUIRE(memory.size() > 20);
    for (std::size_t k = 0; k < memory.size(); ++k)
        for (int c = 0; c < 3; ++c) memory[k].bristle[c] = 1e-6 * double(k + c);
    pile.contact.set_memory(memory);
    const std::vector<real> start = pile.state.pos;
    pile.add(pile.shift(Vec3(2.5 * spacing, 0.5 * spacing, 0)));
    pile.contact.update(pile.state);
    CHECK((in_state(pile.state) == memory));  // too long to print
    pile.state.pos = start;
    pile.contact.update(pile.state);
    CHECK((in_state(pile.state) == memory));
}

TEST_CASE("saved and restored friction memory gives the same bristles in another contact object", "[cloth_contact]")
{
    Pile first(stack(2, 0.7 * gap)), second(stack(2, 0.7 * gap));
    first.contact.update(first.state);
    first.contact.settle(first.state, first.params);
    first.add(first.shift(Vec3(5e-5, -3e-5, 0)));
    first.contact.update(first.state);
    first.contact.settle(first.state, first.params);
    second.state.pos = first.state.pos;
    second.contact.set_memory(first.contact.memory());
    first.contact.update(first.state);
    second.contact.update(second.state);
    const FrictionMemory expected = in_state(first.state);
    double longest = 0;
    for (const PairFriction& friction : expected)
        longest = std::max(longest, std::hypot(friction.bristle[0], friction.bristle[1], friction.bristle[2]));
    CHECK(longest == Approx(std::hypot(5e-5, 3e-5)));
    CHECK((in_state(second.state) == expected));
}

TEST_CASE("an initial tangle is detected, comes apart when pulled, and cannot form again afterwards", "[cloth_contact]")
{
    Cloth cloth = grid_cloth(side, side, spacing);
    add_panel(cloth, grid_cloth(side, side, spacing), Vec3(0.003, 0.005, 0));
    for (int v = side * side; v < 2 * side * side; ++v) cloth.positions[v].z() = 0.5 * (cloth.positions[v].x() - 0.05);
    Pile pile(cloth);
    REQUIRE(pile.contact.counts().tangles > 0);
    double lifted = 0;
    for (int k = 0; k < 50 && pile.contact.counts().tangles > 0; ++k) {
        std::vector<real> move = pile.shift(Vec3(0, 0, 0.25 * gap));
        pile.contact.filter_step(pile.state, move, true);
        pile.add(move);
        lifted += move[2 * pile.stride() + side * side];
        pile.contact.settle(pile.state, pile.params);
    }
    CHECK(pile.contact.counts().tangles == 0);
    CHECK_FALSE(pile.intersects(pile.points()));
    CHECK(lifted > 0.02);
    std::vector<real> back = pile.shift(Vec3(0, 0, -lifted));
    pile.contact.filter_step(pile.state, back, true);
    pile.add(back);
    CHECK_FALSE(pile.intersects(pile.points()));
}

TEST_CASE("a patch on inclined cloth sticks below the Coulomb limit", "[cloth_contact]")
{
    CHECK(slide(std::atan(0.35), 0.4, 0.3).norm() < 1e-4);
}

TEST_CASE("a patch on inclined cloth slides at the Coulomb limit above it", "[cloth_contact]")
{
    const double slope = std::atan(0.8);
    const double gained = (slide(slope, 0.4, 0.12) - slide(slope, 0.4, 0.06)).x() / 0.06;
    CHECK(gained == Approx(9.81 * (std::sin(slope) - 0.4 * std::cos(slope))).epsilon(0.02));
}
