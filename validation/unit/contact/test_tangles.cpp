#include <algorithm>

#include "host/solver/contact/tangles.hpp"
#include "validation/unit/catch.hpp"
#include "validation/unit/contact/small_stack.hpp"

using namespace selvage;

namespace {

constexpr double spacing = 0.02;
constexpr int side = 6, sheet_size = side * side;

// Two sheets, one inclined through the other.
Cloth crossing_sheets()
{
    Cloth cloth = sheets_above_each_other(2, side, spacing, 0);
    for (int v = sheet_size; v < 2 * sheet_size; ++v) cloth.positions[v].z() = 0.5 * (cloth.positions[v].x() - 0.05);
    return cloth;
}

struct Fixture {
    Cloth cloth;
    std::vector<Body> bodies;
    Topology topology;
    State state;
    std::vector<Vec3> corners;
    int version = 0;
    Tangles tangles;

    explicit Fixture(Cloth of, std::vector<Body> with = {}, Params params = {})
        : cloth(std::move(of)), bodies(std::move(with)), topology(make_topology(cloth, false)),
          state(make_state(topology, cloth, test_fabrics(), params, cloth.positions, {})),
          tangles(topology.faces, topology.particle_count, bodies)
    {
        for (const Body& body : bodies)
            corners.insert(corners.end(), body.mesh.vertices.begin(), body.mesh.vertices.end());
    }

    TreeBodies body_corners() const { return {corners, nullptr, version}; }
    void find() { tangles.find(state, body_corners()); }
    void update() { tangles.update(state, body_corners()); }
    void lift(int first_vertex, double by)
    {
        for (int v = first_vertex; v < state.size.vertex_count; ++v) state.pos[2 * state.size.vertex_stride + v] += by;
    }
    long marked(const std::vector<char>& flags) const { return std::count(flags.begin(), flags.end(), 1); }
};

}  // namespace

TEST_CASE("sheets that cross at the start are tangled until they are apart, and not again", "[tangles]")
{
    Fixture sheets(crossing_sheets());
    sheets.find();
    const CrossingFlags& flags = sheets.tangles.flags();
    CHECK(sheets.tangles.tangle_count() > 0);
    CHECK(sheets.marked(flags.tangled) > 0);
    CHECK(sheets.marked(flags.tangled) < 2 * sheet_size);  // far from the line where they cross nothing is marked
    CHECK(sheets.marked(flags.pierced) == 0);
    CHECK(sheets.marked(flags.inside) == 0);
    sheets.lift(sheet_size, 0.1);
    sheets.update();
    CHECK(sheets.tangles.tangle_count() == 0);
    CHECK(flags == CrossingFlags(2 * sheet_size));
    sheets.lift(sheet_size, -0.1);
    sheets.update();
    CHECK(flags == CrossingFlags(2 * sheet_size));
}

TEST_CASE("cloth that a body pierces is tangled and pierced, until the body has moved away", "[tangles]")
{
    Body box;
    box.mesh = box_mesh(Vec3(0.045, 0.045, -0.03), Vec3(0.01, 0.01, 0.06));
    Fixture sheet(grid_cloth(side, side, spacing), {box});
    sheet.find();
    const CrossingFlags& flags = sheet.tangles.flags();
    CHECK(sheet.tangles.tangle_count() > 0);
    CHECK(sheet.marked(flags.pierced) > 0);
    CHECK(flags.pierced == flags.tangled);
    for (Vec3& corner : sheet.corners) corner.z() += 0.1;
    ++sheet.version;
    sheet.update();
    CHECK(sheet.tangles.tangle_count() == 0);
    CHECK(sheet.marked(flags.pierced) == 0);
}

TEST_CASE("a vertex that starts inside a body may come out, and is as others once it has", "[tangles]")
{
    Body box;
    box.mesh = box_mesh(Vec3(-1, -1, -2), Vec3(3, 3, 1));  // well below: only the contact planes say what is inside
    Params params;
    params.body_contact.stiffness = 1;
    Fixture sheet(grid_cloth(side, side, spacing), {box}, params);
    State& state = sheet.state;
    for (int v = 0; v < state.size.vertex_count; ++v) {
        state.contact_normal[2 * state.size.vertex_stride + v] = 1;
        state.contact_offset[v] = v < 5 ? 0.01 : -0.01;  // of planes, above and below the sheet
    }
    sheet.find();
    const std::vector<char>& inside = sheet.tangles.flags().inside;
    CHECK(sheet.tangles.inside_count() == 5);
    CHECK(std::all_of(inside.begin(), inside.begin() + 5, [](char flag) { return flag == 1; }));
    sheet.lift(3, 0.02);
    sheet.update();
    CHECK(sheet.tangles.inside_count() == 3);
    sheet.lift(3, -0.02);
    sheet.update();
    CHECK(sheet.tangles.inside_count() == 3);
    CHECK(sheet.marked(inside) == 3);
}

TEST_CASE("flags that are handed over are looked at again like those that were found", "[tangles]")
{
    Fixture found(crossing_sheets()), resumed(crossing_sheets());
    found.find();
    resumed.tangles.set_flags(found.tangles.flags());
    CHECK(resumed.tangles.flags() == found.tangles.flags());
    CHECK(resumed.tangles.tangle_count() > 0);
    resumed.update();
    CHECK(resumed.tangles.tangle_count() == found.tangles.tangle_count());
    resumed.lift(sheet_size, 0.1);
    resumed.update();
    CHECK(resumed.tangles.tangle_count() == 0);
}
