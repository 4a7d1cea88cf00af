#include "host/examine/mesh_edges.hpp"

#include <algorithm>
#include <tuple>

#include <tbb/parallel_sort.h>

#include "host/mesh/triangle_tree.hpp"

namespace selvage {
namespace {

constexpr double on_edge = 1e-5;  // of its length; a file of six digits puts a vertex no nearer to a line

}  // namespace

std::vector<FaceSide> sorted_sides(const std::vector<Face>& faces)
{
    std::vector<FaceSide> sides;
    sides.reserve(3 * faces.size());
    for (int f = 0; f < int(faces.size()); ++f)
        for (int k = 0; k < 3; ++k) {
            const int a = faces[f][k], b = faces[f][(k + 1) % 3];
            sides.push_back({std::min(a, b), std::max(a, b), f, a < b});
        }
    tbb::parallel_sort(sides.begin(), sides.end(), [](const FaceSide& a, const FaceSide& b) {
        return std::tie(a.low, a.high, a.face) < std::tie(b.low, b.high, b.face);
    });
    return sides;
}

Pieces pieces_of(JoinedSets& sets, std::size_t face_count)
{
    Pieces pieces;
    pieces.of_face.resize(face_count);
    for (int f = 0; f < int(face_count); ++f) {
        const int root = sets.root(f);
        if (root == f) {
            pieces.of_face[f] = pieces.count();
            pieces.first_face.push_back(f);
            pieces.face_count.push_back(0);
        } else {
            pieces.of_face[f] = pieces.of_face[root];
        }
        ++pieces.face_count[pieces.of_face[f]];
    }
    return pieces;
}

Pieces pieces_by_edges(const std::vector<FaceSide>& sides, std::size_t face_count)
{
    JoinedSets sets(face_count);
    for_each_edge(sides, [&](const FaceSide* first, const FaceSide* end) {
        for (const FaceSide* side = first + 1; side < end; ++side) sets.join(first->face, side->face);
    });
    return pieces_of(sets, face_count);
}

std::vector<FaceSide> rim_sides(const std::vector<FaceSide>& sides)
{
    std::vector<FaceSide> rim;
    for_each_edge(sides, [&](const FaceSide* first, const FaceSide* end) {
        if (end - first == 1) rim.push_back(*first);
    });
    return rim;
}

std::vector<std::vector<int>> rim_loops(const std::vector<FaceSide>& rim)
{
    // By the vertex at which a face over the hole would begin to run along the side.
    std::vector<FaceSide> waiting = rim;
    std::sort(waiting.begin(), waiting.end(), [](const FaceSide& a, const FaceSide& b) {
        return std::tuple(a.to(), a.from()) < std::tuple(b.to(), b.from());
    });
    std::vector<char> used(waiting.size());
    const auto take_from = [&](int vertex) {
        auto side = std::lower_bound(waiting.begin(), waiting.end(), vertex,
                                     [](const FaceSide& a, int v) { return a.to() < v; });
        for (; side != waiting.end() && side->to() == vertex; ++side)
            if (char& taken = used[std::size_t(side - waiting.begin())]; !taken) {
                taken = 1;
                return side->from();
            }
        return -1;
    };
    std::vector<std::vector<int>> loops;
    for (std::size_t k = 0; k < waiting.size(); ++k) {
        if (used[k]) continue;
        std::vector<int> loop{waiting[k].to()};
        int at = take_from(loop.front());
        while (at >= 0 && at != loop.front()) {
            loop.push_back(at);
            at = take_from(at);
        }
        if (at == loop.front()) loops.push_back(std::move(loop));
    }
    return loops;
}

std::vector<VertexOnEdge> vertices_on_rims(const std::vector<Vec3>& vertices, const std::vector<FaceSide>& rim)
{
    // Points and edges as triangles without area, for the tree's search by boxes; the points' reach over what lies
    // near.
    std::vector<int> points;
    for (const FaceSide& side : rim) points.insert(points.end(), {side.low, side.high});
    std::sort(points.begin(), points.end());
    points.erase(std::unique(points.begin(), points.end()), points.end());
    std::vector<Face> edges, spots;
    double longest = 0;
    for (const FaceSide& side : rim) {
        edges.push_back({side.low, side.high, side.high});
        longest = std::max(longest, (vertices[side.high] - vertices[side.low]).norm());
    }
    std::vector<Vec3> corners;
    const Vec3 reach = Vec3::Constant(on_edge * longest);
    for (const int v : points) {
        spots.push_back({int(corners.size()), int(corners.size()) + 1, int(corners.size())});
        corners.insert(corners.end(), {vertices[v] - reach, vertices[v] + reach});
    }
    const TriangleTree edge_tree(vertices, edges), spot_tree(corners, spots);
    const auto lies_on = [&](int spot, int edge) {
        const int v = points[spot];
        const Vec3 &a = vertices[rim[edge].low], &b = vertices[rim[edge].high], &x = vertices[v];
        if (v == rim[edge].low || v == rim[edge].high || x == a || x == b) return false;
        const Vec3 along = b - a;
        const double s = (x - a).dot(along) / along.squaredNorm();
        return s > on_edge && s < 1 - on_edge && (x - a - s * along).norm() <= on_edge * along.norm();
    };
    std::vector<VertexOnEdge> found;
    for (const auto& [spot, edge] : spot_tree.pairs_with(edge_tree, lies_on))
        found.push_back({points[spot], rim[edge].low, rim[edge].high});
    return found;
}

}  // namespace selvage
