#pragma once
#include <numeric>
#include <vector>

#include "io/geometry.hpp"

namespace selvage {

/// A side of a face.
struct FaceSide {
    int low = 0, high = 0;  ///< Its vertices.
    int face = 0;
    bool forward = true;  ///< The face runs from low to high.

    int from() const { return forward ? low : high; }
    int to() const { return forward ? high : low; }
};

/// Returns the sides of all faces, those of one edge together, sorted by vertices and then by face.
std::vector<FaceSide> sorted_sides(const std::vector<Face>& faces);

/// Calls visit(first, end) for the sides of each edge.
template <class Visit>
void for_each_edge(const std::vector<FaceSide>& sides, const Visit& visit)
{
    for (std::size_t begin = 0, end = 0; begin < sides.size(); begin = end) {
        for (end = begin;
             end < sides.size() && sides[end].low == sides[begin].low && sides[end].high == sides[begin].high;)
            ++end;
        visit(sides.data() + begin, sides.data() + end);
    }
}

/// Sets that are joined step by step (union-find); the smallest item stands for its set.
class JoinedSets {
public:
    explicit JoinedSets(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0); }
    int root(int item)
    {
        while (parent_[item] != item) item = parent_[item] = parent_[parent_[item]];
        return item;
    }
    void join(int a, int b)
    {
        const int one = root(a), two = root(b);
        parent_[one < two ? two : one] = one < two ? one : two;
    }

private:
    std::vector<int> parent_;
};

/// The connected pieces of a mesh, in the order of their first faces.
struct Pieces {
    std::vector<int> of_face;
    std::vector<int> first_face;  ///< Of each piece.
    std::vector<int> face_count;
    int count() const { return int(first_face.size()); }
};

/// Returns the pieces of faces that are connected by common edges.
Pieces pieces_by_edges(const std::vector<FaceSide>& sides, std::size_t face_count);

/// Returns the pieces whose faces the sets hold together.
Pieces pieces_of(JoinedSets& sets, std::size_t face_count);

/// Returns the sides of edges with a single face: the rims.
std::vector<FaceSide> rim_sides(const std::vector<FaceSide>& sides);

/// Returns the rims as loops of vertices, each against the direction of its faces, so that a face over the hole would
/// run along it. Where rims touch, one of the ways on is taken; a chain that does not close is left out.
std::vector<std::vector<int>> rim_loops(const std::vector<FaceSide>& rim);

/// A vertex that lies on an edge without being one of its ends.
struct VertexOnEdge {
    int vertex = 0;
    int from = 0, to = 0;
};

/// Returns the vertices of rims that lie on the edges of rims, within a part of the edge's length, sorted.
std::vector<VertexOnEdge> vertices_on_rims(const std::vector<Vec3>& vertices, const std::vector<FaceSide>& rim);

}  // namespace selvage
