#include "host/mesh/self_intersections.hpp"

#include <algorithm>
#include <limits>

#include <tbb/parallel_for.h>

namespace selvage {
namespace {

// Marks the triangles that have an area. Degenerate triangles count as intersecting nothing.
std::vector<char> with_area(const TriangleTree& mesh, std::size_t count)
{
    std::vector<char> result(count);
    tbb::parallel_for(std::size_t(0), count, [&](std::size_t f) { result[f] = !is_degenerate(mesh.triangle(int(f))); });
    return result;
}

int shared_corners(const Face& f, const Face& g)
{
    return int(std::count_if(f.begin(), f.end(), [&](int v) { return std::find(g.begin(), g.end(), v) != g.end(); }));
}

// True if the edge of f opposite the corner that f shares with g intersects g.
bool far_edge_meets(const TriangleTree& mesh, int f, int g)
{
    const Face &corners = mesh.face(f), &others = mesh.face(g);
    for (int k = 0; k < 3; ++k) {
        const int a = corners[k], b = corners[(k + 1) % 3];
        const bool touches = std::any_of(others.begin(), others.end(), [&](int v) { return v == a || v == b; });
        if (!touches && segment_meets_triangle(mesh.vertex(a), mesh.vertex(b), mesh.triangle(g))) return true;
    }
    return false;
}

// Looks for a separating plane perpendicular to the line between the centroids of two triangles; if they share a
// corner, the plane must pass through it. Such a plane spares the exact predicates. Most pairs are neighbours in nearly
// flat cloth, and coplanar triangles need the most expensive predicates.
// @param shared  a corner of both, or -1
bool are_separated(const TriangleTree& a, int f, const TriangleTree& b, int g, int shared)
{
    const Triangle p = a.triangle(f), q = b.triangle(g);
    const Vec3 middle = (q[0] + q[1] + q[2]) / 3, across = (p[0] + p[1] + p[2]) / 3 - middle;
    double least = std::numeric_limits<double>::infinity(), most = -least, size = 0;
    for (int k = 0; k < 3; ++k) {
        size = std::max({size, p[k].cwiseAbs().maxCoeff(), q[k].cwiseAbs().maxCoeff()});
        if (a.face(f)[k] != shared) least = std::min(least, across.dot(p[k] - middle));
        if (b.face(g)[k] != shared) most = std::max(most, across.dot(q[k] - middle));
    }
    const double margin = 1e-13 * size * across.norm();  // hundreds of times the rounding error of these sums
    if (shared < 0) return least > most + margin;
    const double at = across.dot(a.vertex(shared) - middle);
    return least > at + margin && most < at - margin;
}

int shared_corner(const Face& f, const Face& g) { return *std::find_first_of(f.begin(), f.end(), g.begin(), g.end()); }

}  // namespace

std::vector<IntersectingPair> self_intersections(const std::vector<Vec3>& vertices, const std::vector<Face>& faces)
{
    const TriangleTree mesh(vertices, faces);
    const std::vector<char> has_area = with_area(mesh, faces.size());
    return mesh.own_pairs([&](int a, int b) {
        if (!has_area[a] || !has_area[b]) return false;
        const int shared = shared_corners(mesh.face(a), mesh.face(b));
        if (shared > 1) return false;
        if (are_separated(mesh, a, mesh, b, shared == 1 ? shared_corner(mesh.face(a), mesh.face(b)) : -1)) return false;
        if (shared == 0) return triangles_meet(mesh.triangle(a), mesh.triangle(b));
        return far_edge_meets(mesh, a, b) || far_edge_meets(mesh, b, a);
    });
}

IntersectionTarget::IntersectionTarget(TriangleMesh mesh)
    : mesh_(std::move(mesh)), tree_(mesh_.vertices, mesh_.faces), has_area_(with_area(tree_, mesh_.faces.size()))
{
}

std::vector<IntersectingPair> IntersectionTarget::intersections(const std::vector<Vec3>& vertices,
                                                                const std::vector<Face>& faces) const
{
    const TriangleTree mine(vertices, faces);
    const std::vector<char> mine_has_area = with_area(mine, faces.size());
    return mine.pairs_with(tree_, [&](int a, int b) {
        return mine_has_area[a] && has_area_[b] && !are_separated(mine, a, tree_, b, -1) &&
               triangles_meet(mine.triangle(a), tree_.triangle(b));
    });
}

std::vector<IntersectingPair> mutual_intersections(const std::vector<Vec3>& vertices, const std::vector<Face>& faces,
                                                   const TriangleMesh& other)
{
    return IntersectionTarget(other).intersections(vertices, faces);
}

}  // namespace selvage
