#include "host/collision/parted_body.hpp"

#include <algorithm>

#include "host/collision/body_query.hpp"
#include "host/collision/surface_points.hpp"

namespace selvage {
namespace {

// Chosen on trousers and jumpsuits on three bodies whose thighs touch or overlap by up to 4 mm.
struct PartingTuning {
    static constexpr double deepest = 0.01;  // overlap that is found [m]
    static constexpr double facing = -0.3;   // cosine between a normal and that of what it meets, at most: 107 degrees
    static constexpr double give = 0.15;     // of the radius of the ball within, at most: thighs 10 mm, fingers 1 mm
    // How near the way of a seam must pass [m]. The seams of trousers pass where thighs touch at 4 to 11 mm, those of
    // 20 other garments at 120 mm and more.
    static constexpr double near_seam = 0.05;
    // Part of a body's height below which parts give way: legs and seat. Lips, eyes and ears that gave way tangled a
    // thin head, and a hoody was never sewn on it.
    static constexpr double legs = 0.55;
    static constexpr int rounds = 3;          // of giving way: surfaces do not move straight towards each other
    static constexpr int smooth_rounds = 6;   // in which what lies around follows
    static constexpr int fill_rounds = 20;    // in which the balls where parts overlap become as large as those around
    static constexpr double follows = 0.8;    // of the mean around it
    static constexpr double enough = 0.0001;  // [m]: no round is made for less
};

Box reach_of(const std::vector<SeamWay>& ways)
{
    Box box;
    for (const SeamWay& way : ways)
        for (const Vec3& end : way) box.extend(end);
    const Vec3 margin = Vec3::Constant(PartingTuning::near_seam);
    return {box.min() - margin, box.max() + margin};
}

bool is_near(const std::vector<SeamWay>& ways, const Vec3& x)
{
    return std::any_of(ways.begin(), ways.end(), [&x](const SeamWay& way) {
        const Vec3 along = way[1] - way[0];
        const double part = std::clamp((x - way[0]).dot(along) / along.squaredNorm(), 0.0, 1.0);
        return (way[0] + part * along - x).norm() < PartingTuning::near_seam;
    });
}

// How far each point has to give way [m]. @param region  only points within do
std::vector<double> shortages(const TriangleMesh& mesh, const SurfacePoints& surface, double room, const Box& region)
{
    const int count = int(surface.points.size());
    std::vector<double> from(3 * surface.points.size()), to(from.size());
    for (int k = 0; k < count; ++k)
        for (int c = 0; c < 3; ++c) {
            from[c * count + k] = surface.points[k][c] - PartingTuning::deepest * surface.normals[k][c];
            to[c * count + k] = surface.points[k][c] + room * surface.normals[k][c];
        }
    Body body;
    body.mesh = mesh;
    BodyQuery query({body}, region);
    const std::vector<BodyCrossing> met = query.crossings(from.data(), to.data(), count, count);
    std::vector<double> result(surface.points.size());
    for (int k = 0; k < count; ++k) {
        if (met[k].body < 0 || !region.contains(surface.points[k])) continue;
        const Face& face = mesh.faces[met[k].triangle];
        const Vec3& corner = mesh.vertices[face[0]];
        const Vec3 normal = (mesh.vertices[face[1]] - corner).cross(mesh.vertices[face[2]] - corner).normalized();
        if (normal.dot(surface.normals[k]) > PartingTuning::facing) continue;
        const double way = met[k].fraction * (room + PartingTuning::deepest) - PartingTuning::deepest;
        result[k] = 0.5 * std::max(room - way, 0.0);
    }
    return result;
}

// Whether the way of a seam passes where parts touch: a skirt has no cloth there.
bool closes_between(const SurfacePoints& surface, const std::vector<double>& shortage, const std::vector<SeamWay>& ways)
{
    for (std::size_t k = 0; k < shortage.size(); ++k)
        if (shortage[k] > 0 && is_near(ways, surface.points[k])) return true;
    return false;
}

std::vector<Vec3> parted_vertices(TriangleMesh mesh, double room, const std::vector<SeamWay>& seams)
{
    const SurfacePoints whole = surface_points(mesh);
    const Box box = box_of(mesh.vertices);
    Box region = reach_of(seams);
    region.max().z() = std::min(region.max().z(), box.min().z() + PartingTuning::legs * box.sizes().z());
    if (region.isEmpty()) return std::move(mesh.vertices);
    std::vector<double> radii = thickness_of(whole).radii;
    // No ball fits within where parts overlap.
    smooth(whole, radii, PartingTuning::fill_rounds, [](double own, double mean) { return std::max(own, mean); });
    std::vector<double> given(radii.size());
    for (int round = 0; round < PartingTuning::rounds; ++round) {
        const SurfacePoints surface = surface_points(mesh);
        std::vector<double> ways = shortages(mesh, surface, room, region);
        if (*std::max_element(ways.begin(), ways.end()) < PartingTuning::enough) break;
        if (round == 0 && !closes_between(surface, ways, seams)) break;
        smooth(surface, ways, PartingTuning::smooth_rounds,
               [](double own, double mean) { return std::max(own, PartingTuning::follows * mean); });
        for (std::size_t k = 0; k < ways.size(); ++k) {
            ways[k] = std::min(ways[k], std::max(PartingTuning::give * radii[k] - given[k], 0.0));
            given[k] += ways[k];
        }
        for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
            const int k = surface.point_of[v];
            mesh.vertices[v] -= ways[k] * surface.normals[k];
        }
    }
    return std::move(mesh.vertices);
}

}  // namespace

std::vector<Body> parted_bodies(const std::vector<Body>& bodies, double room, std::vector<SeamWay> ways)
{
    std::erase_if(ways, [](const SeamWay& way) { return way[0] == way[1]; });
    std::vector<Body> parted = bodies;
    if (ways.empty()) return parted;
    for (Body& body : parted)
        if (body.kind == Body::Kind::mesh && !body.motion && !body.mesh.vertices.empty())
            body.mesh.vertices = parted_vertices(body.mesh, room, ways);
    return parted;
}

}  // namespace selvage
