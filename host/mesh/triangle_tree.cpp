#include "host/mesh/triangle_tree.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>

namespace selvage {
namespace {

// These affect speed only. Chosen by hand; not measured.
struct TriangleTreeTuning {
    static constexpr int serial_leaves = 512;          // one thread builds subtrees of up to this many leaves
    static constexpr std::size_t search_pieces = 256;  // node pairs from which on a search runs in parallel
};

}  // namespace

void TriangleTree::Box::add(const Box& other)
{
    for (int c = 0; c < 3; ++c) {
        low[c] = std::min(low[c], other.low[c]);
        high[c] = std::max(high[c], other.high[c]);
    }
}

bool TriangleTree::Box::overlaps(const Box& other) const
{
    return low[0] <= other.high[0] && other.low[0] <= high[0] && low[1] <= other.high[1] && other.low[1] <= high[1] &&
           low[2] <= other.high[2] && other.low[2] <= high[2];
}

// Returns the box of a triangle in single precision, rounded outwards.
TriangleTree::Box TriangleTree::box_of(int face) const
{
    constexpr float far = std::numeric_limits<float>::infinity();
    const Triangle t = triangle(face);
    const Vec3 low = t[0].cwiseMin(t[1]).cwiseMin(t[2]), high = t[0].cwiseMax(t[1]).cwiseMax(t[2]);
    Box box;
    for (int c = 0; c < 3; ++c) {
        box.low[c] = std::nextafter(float(low[c]), -far);
        box.high[c] = std::nextafter(float(high[c]), far);
    }
    return box;
}

TriangleTree::TriangleTree(const std::vector<Vec3>& vertices, const std::vector<Face>& faces)
    : vertices_(vertices), faces_(faces), order_(faces.size()), boxes_(faces.size())
{
    if (faces.empty()) return;
    std::iota(order_.begin(), order_.end(), 0);
    const int leaves = (int(faces.size()) + leaf_size - 1) / leaf_size;
    nodes_.resize(2 * std::size_t(leaves) - 1);
    build(0, 0, leaves);
}

// Builds a subtree of `leaves` full leaves from the triangles at `first` and after in tree order.
void TriangleTree::build(int node, int first, int leaves)
{
    Node& n = nodes_[node];
    n.first = first;
    n.count = std::min(leaves * leaf_size, int(order_.size()) - first);
    if (leaves == 1) {
        for (int k = first; k < first + n.count; ++k) boxes_[k] = box_of(order_[k]);
        n.box = boxes_[first];
        for (int k = first + 1; k < first + n.count; ++k) n.box.add(boxes_[k]);
        return;
    }
    const auto middle = [this](int f) -> Vec3 {
        return vertices_[faces_[f][0]] + vertices_[faces_[f][1]] + vertices_[faces_[f][2]];
    };
    Eigen::AlignedBox3d span;
    for (int k = first; k < first + n.count; ++k) span.extend(middle(order_[k]));
    int axis = 0;
    span.sizes().maxCoeff(&axis);
    const int left = leaves / 2, split = first + left * leaf_size;
    std::nth_element(order_.begin() + first, order_.begin() + split, order_.begin() + first + n.count,
                     [&](int f, int g) {
                         const double a = middle(f)[axis], b = middle(g)[axis];
                         return a < b || (a == b && f < g);
                     });
    n.right = node + 2 * left;
    const auto build_left = [&] { build(node + 1, first, left); };
    const auto build_right = [&] { build(n.right, split, leaves - left); };
    if (leaves > TriangleTreeTuning::serial_leaves) {
        tbb::parallel_invoke(build_left, build_right);
    } else {
        build_left();
        build_right();
    }
    n.box = nodes_[node + 1].box;
    n.box.add(nodes_[n.right].box);
}

// Simultaneous traversal from the roots of two trees, or of one tree with itself.
struct TriangleTree::Search {
    const TriangleTree &a, &b;
    const Meet& meet;
    bool own;

    void offer(int i, int j, std::vector<TrianglePair>& found) const
    {
        if (!a.boxes_[i].overlaps(b.boxes_[j])) return;
        int f = a.order_[i], g = b.order_[j];
        if (own && f > g) std::swap(f, g);
        if (meet(f, g)) found.push_back({f, g});
    }

    void visit(NodePair pair, std::vector<NodePair>& open, std::vector<TrianglePair>& found) const
    {
        const Node &na = a.nodes_[pair[0]], &nb = b.nodes_[pair[1]];
        const bool same = own && pair[0] == pair[1];
        if (!same && !na.box.overlaps(nb.box)) return;
        if (same && na.right > 0) {
            open.insert(open.end(), {{pair[0] + 1, pair[0] + 1}, {na.right, na.right}, {pair[0] + 1, na.right}});
        } else if (na.right == 0 && nb.right == 0) {
            for (int i = na.first; i < na.first + na.count; ++i)
                for (int j = same ? i + 1 : nb.first; j < nb.first + nb.count; ++j) offer(i, j, found);
        } else if (nb.right == 0 || (na.right > 0 && na.count >= nb.count)) {
            open.insert(open.end(), {{pair[0] + 1, pair[1]}, {na.right, pair[1]}});
        } else {
            open.insert(open.end(), {{pair[0], pair[1] + 1}, {pair[0], nb.right}});
        }
    }

    std::vector<TrianglePair> all() const
    {
        std::vector<TrianglePair> pairs;
        if (a.nodes_.empty() || b.nodes_.empty()) return pairs;
        std::vector<NodePair> pieces{{0, 0}};
        std::size_t next = 0;
        while (next < pieces.size() && pieces.size() - next < TriangleTreeTuning::search_pieces) {
            const NodePair piece = pieces[next++];
            visit(piece, pieces, pairs);
        }
        std::vector<std::vector<TrianglePair>> found(pieces.size());
        tbb::parallel_for(next, pieces.size(), [&](std::size_t p) {
            std::vector<NodePair> open{pieces[p]};
            while (!open.empty()) {
                const NodePair pair = open.back();
                open.pop_back();
                visit(pair, open, found[p]);
            }
        });
        for (const std::vector<TrianglePair>& of_piece : found)
            pairs.insert(pairs.end(), of_piece.begin(), of_piece.end());
        std::sort(pairs.begin(), pairs.end());
        return pairs;
    }
};

std::vector<TrianglePair> TriangleTree::own_pairs(const Meet& meet) const
{
    return Search{*this, *this, meet, true}.all();
}

std::vector<TrianglePair> TriangleTree::pairs_with(const TriangleTree& other, const Meet& meet) const
{
    return Search{*this, other, meet, false}.all();
}

}  // namespace selvage
