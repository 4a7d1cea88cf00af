#pragma once
#include <array>
#include <functional>
#include <vector>

#include "host/mesh/triangle_intersection.hpp"
#include "io/geometry.hpp"

namespace selvage {

/// The indices of two triangles.
using TrianglePair = std::array<int, 2>;

/// A bounding volume hierarchy over the triangles of a mesh, split at the median along the longest side of their
/// centroids' box. It serves single queries of a shape without a ray tracing library.
class TriangleTree {
public:
    /// @param vertices  finite positions [m]; like the faces they must outlive this object
    TriangleTree(const std::vector<Vec3>& vertices, const std::vector<Face>& faces);

    /// What the tree of so many faces takes, beside vertices and faces [bytes].
    static std::size_t bytes_of(std::size_t faces)
    {
        return faces * (sizeof(int) + sizeof(Box) + 2 * sizeof(Node) / leaf_size);
    }

    const Face& face(int f) const { return faces_[f]; }
    const Vec3& vertex(int v) const { return vertices_[v]; }
    Triangle triangle(int f) const
    {
        return {vertices_[faces_[f][0]], vertices_[faces_[f][1]], vertices_[faces_[f][2]]};
    }

    using Meet = std::function<bool(int, int)>;  ///< Exact test; called by several threads at once.

    /// Returns the pairs of different triangles whose boxes overlap and which meet, the smaller index first, sorted.
    std::vector<TrianglePair> own_pairs(const Meet& meet) const;
    /// Returns the pairs of a triangle of this mesh and one of another whose boxes overlap and which meet, sorted.
    std::vector<TrianglePair> pairs_with(const TriangleTree& other, const Meet& meet) const;

private:
    struct Box {
        std::array<float, 3> low, high;
        void add(const Box& other);
        bool overlaps(const Box& other) const;
    };
    struct Node {
        Box box;
        int first = 0, count = 0;  // its triangles, in tree order
        int right = 0;             // second child, the first comes next; 0: a leaf
    };
    using NodePair = std::array<int, 2>;
    struct Search;
    static constexpr int leaf_size = 4;  // triangles per leaf; chosen by hand, not measured

    Box box_of(int face) const;
    void build(int node, int first, int leaves);

    const std::vector<Vec3>& vertices_;
    const std::vector<Face>& faces_;
    std::vector<int> order_;
    std::vector<Box> boxes_;  // in tree order
    std::vector<Node> nodes_;
};

}  // namespace selvage
