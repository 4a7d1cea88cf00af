#include <algorithm>
#include <cmath>

#include "host/collision/thin_body.hpp"
#include "validation/unit/catch.hpp"

using namespace selvage;

namespace {

// A closed tube of rings about the z axis. @param radius  of the rings from bottom to top [m]
TriangleMesh tube(const std::vector<double>& radius, double spacing)
{
    constexpr int around = 24;
    TriangleMesh mesh;
    const int rings = int(radius.size());
    for (int r = 0; r < rings; ++r)
        for (int k = 0; k < around; ++k) {
            const double angle = 2 * 3.14159265358979 * k / around;
            mesh.vertices.emplace_back(radius[r] * std::cos(angle), radius[r] * std::sin(angle), r * spacing);
        }
    mesh.vertices.emplace_back(0, 0, 0);
    mesh.vertices.emplace_back(0, 0, (rings - 1) * spacing);
    const int bottom = rings * around, top = bottom + 1;
    for (int k = 0; k < around; ++k) {
        const int next = (k + 1) % around, last = (rings - 1) * around;
        mesh.faces.push_back({bottom, next, k});
        mesh.faces.push_back({top, last + k, last + next});
        for (int r = 0; r + 1 < rings; ++r) {
            const int low = r * around, high = low + around;
            mesh.faces.push_back({low + k, low + next, high + next});
            mesh.faces.push_back({low + k, high + next, high + k});
        }
    }
    return mesh;
}

double distance_from_axis(const Vec3& x) { return std::hypot(x.x(), x.y()); }

Body body_of(TriangleMesh mesh)
{
    Body body;
    body.mesh = std::move(mesh);
    return body;
}

}  // namespace

TEST_CASE("a limb becomes thin by the part that is asked for, and its axis stays where it is")
{
    const TriangleMesh mesh = tube(std::vector<double>(41, 0.05), 0.02);
    const std::vector<Vec3> thin = thin_vertices(mesh, 0.75);
    REQUIRE(thin.size() == mesh.vertices.size());
    for (std::size_t v = 0; v < thin.size(); ++v) {
        if (mesh.vertices[v].z() < 0.2 || mesh.vertices[v].z() > 0.6) continue;
        CHECK(distance_from_axis(thin[v]) < 0.4 * 0.05);  // ways are smoothed, which takes some of them
        CHECK(distance_from_axis(thin[v]) > 0.2 * 0.05);
        CHECK(thin[v].z() == Approx(mesh.vertices[v].z()).margin(1e-3));
    }
    CHECK(thin_vertices(mesh, 0) == mesh.vertices);
}

TEST_CASE("a body of thick and thin limbs becomes thin everywhere and stays within itself")
{
    std::vector<double> radius(21, 0.12);
    radius.insert(radius.end(), 20, 0.04);
    const TriangleMesh mesh = tube(radius, 0.02);
    const std::vector<Vec3> thin = thin_vertices(mesh, 0.75);
    for (std::size_t v = 0; v < thin.size(); ++v) {
        const Vec3& x = mesh.vertices[v];
        CHECK(distance_from_axis(thin[v]) <= distance_from_axis(x) + 1e-9);
        if (x.z() > 0.15 && x.z() < 0.25) CHECK(distance_from_axis(thin[v]) < 0.5 * 0.12);
        if (x.z() > 0.55 && x.z() < 0.65) CHECK(distance_from_axis(thin[v]) < 0.5 * 0.04);
    }
}

TEST_CASE("vertices of a mesh that stand at one place move together")
{
    TriangleMesh mesh = tube(std::vector<double>(21, 0.05), 0.02);
    const int copied = 10 * 24;
    mesh.vertices.push_back(mesh.vertices[copied]);
    for (Face& face : mesh.faces)
        if (face[0] == copied) face[0] = int(mesh.vertices.size()) - 1;
    const std::vector<Vec3> thin = thin_vertices(mesh, 0.5);
    CHECK(thin.back() == thin[copied]);
}

TEST_CASE("a thin body grows to what it was, ever more slowly, and stands still before and after")
{
    const std::vector<Body> whole = {body_of(tube(std::vector<double>(21, 0.05), 0.02))};
    const std::vector<Body> thin = thin_bodies(whole, 0.75);
    const Body growing = growing_bodies(thin, whole, 2, 0.5)[0];
    CHECK(body_mesh_at(growing, 0).vertices == thin[0].mesh.vertices);
    CHECK(body_mesh_at(growing, 2).vertices == thin[0].mesh.vertices);
    CHECK(growing.motion->end() == Approx(2.5));
    CHECK(body_mesh_at(growing, 2.5).vertices == whole[0].mesh.vertices);
    const auto girth = [&](double time) { return distance_from_axis(body_mesh_at(growing, time).vertices[10 * 24]); };
    const double start = girth(2), early = girth(2.1), late = girth(2.4), end = girth(2.5);
    CHECK(early - start > end - late);
    CHECK(end > late);
}

TEST_CASE("a body that stands between the sides of a seam is told from one beside it")
{
    const std::vector<Body> bodies = {body_of(tube(std::vector<double>(21, 0.05), 0.02))};
    Cloth cloth;
    cloth.positions = {{-0.1, 0, 0.2}, {0.1, 0, 0.2}, {-0.1, 0.2, 0.2}, {0.1, 0.2, 0.2}};
    cloth.panel_coordinates.resize(4);
    cloth.seam_pairs = {{2, 3}};
    CHECK(!seams_meet_bodies(cloth, bodies));
    cloth.seam_pairs = {{2, 3}, {0, 1}};
    CHECK(seams_meet_bodies(cloth, bodies));
    cloth.positions[1] = cloth.positions[0];
    CHECK(!seams_meet_bodies(cloth, bodies));
    CHECK(!seams_meet_bodies(cloth, {}));
}
