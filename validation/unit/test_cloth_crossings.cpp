#include <catch2/catch.hpp>

#include <cmath>

#include "host/collision/cloth_crossings.hpp"
#include "host/solver/cloth_contact.hpp"
#include "validation/small_cloth.hpp"

using namespace selvage;

namespace {

int crossings(const Cloth& cloth, const std::vector<Vec3>& positions)
{
    const Topology topology = make_topology(cloth, true);
    std::vector<double> planes;
    for (int c = 0; c < 3; ++c)
        for (const Vec3& x : positions) planes.push_back(x[c]);
    return count_crossings(tree_surface(topology, cloth), planes.data(), int(positions.size()), topology.particle_count);
}

// The sheet rolled up around the y axis with a radius that changes from turn to turn.
std::vector<Vec3> rolled(const Cloth& cloth, double radius, double rise)
{
    std::vector<Vec3> positions;
    for (const Vec2& x : cloth.panel_coordinates) {
        const double angle = x.x() / radius, r = radius + rise * angle;
        positions.push_back(Vec3(r * std::sin(angle), x.y(), r * std::cos(angle)));
    }
    return positions;
}

}  // namespace

TEST_CASE("a flat sheet and a roll whose turns stay apart are free of crossings")
{
    const Cloth cloth = grid_cloth(40, 6, 0.02);
    CHECK(crossings(cloth, cloth.positions) == 0);
    CHECK(crossings(cloth, rolled(cloth, 0.07, 0.004)) == 0);
}

TEST_CASE("crossings are counted where cloth passes through cloth, as by looking at all pairs")
{
    const Cloth cloth = grid_cloth(40, 6, 0.02);
    std::vector<Vec3> positions = rolled(cloth, 0.07, 0.004);
    // The end of the roll dips through the turn below it.
    for (std::size_t v = 0; v < positions.size(); ++v)
        if (cloth.panel_coordinates[v].x() > 0.76) positions[v] *= 0.7;
    CHECK(crossings(cloth, positions) > 0);

    // A vertex pushed through a neighbour's face: its edges pass through faces that are near at rest.
    positions = cloth.positions;
    for (Vec3& x : positions) x.z() = 0;
    positions[2 * 40 + 10] = cloth.positions[2 * 40 + 13] + Vec3(0.003, 0.002, -0.01);
    CHECK(crossings(cloth, positions) > 0);
}

TEST_CASE("one sheet stuck through another gives as many crossings as edges pass through faces")
{
    Cloth cloth = grid_cloth(3, 3, 1);
    const Cloth second = grid_cloth(2, 2, 1);
    cloth.panels.push_back(second.panels.front());
    cloth.panels.back().first_vertex = 9;
    cloth.panels.back().first_face = int(cloth.faces.size());
    for (Face face : second.faces) cloth.faces.push_back({face[0] + 9, face[1] + 9, face[2] + 9});
    cloth.panel_coordinates.insert(cloth.panel_coordinates.end(), second.panel_coordinates.begin(), second.panel_coordinates.end());
    // Upright, its lower edge below the first sheet: two sides and the diagonal pass through; no edge of the first
    // sheet meets its faces, since it stands within one of them.
    for (const Vec2& x : second.panel_coordinates)
        cloth.positions.push_back(Vec3(0.55 + 0.1 * x.x(), 0.25 + 0.02 * x.x(), x.y() - 0.4));
    CHECK(crossings(cloth, cloth.positions) == 3);
    for (std::size_t v = 9; v < 13; ++v) cloth.positions[v].z() += 0.5;
    CHECK(crossings(cloth, cloth.positions) == 0);
}
