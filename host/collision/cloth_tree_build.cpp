// Construction of a ClothTree, once per phase.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "host/collision/cloth_tree.hpp"

namespace selvage {
namespace {

bool overlap(const Vec2& low_a, const Vec2& high_a, const Vec2& low_b, const Vec2& high_b)
{
    return (low_a.array() <= high_b.array()).all() && (low_b.array() <= high_a.array()).all();
}

// Edges that belong to one face only, as pairs (face, local edge).
std::vector<std::array<int, 2>> outline_of(const std::vector<Face>& faces, int first, int count)
{
    struct Side {
        int low, high, face, local;
    };
    std::vector<Side> sides;
    for (int f = first; f < first + count; ++f)
        for (int k = 0; k < 3; ++k) {
            const int a = faces[f][k], b = faces[f][(k + 1) % 3];
            sides.push_back({std::min(a, b), std::max(a, b), f, k});
        }
    std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
        return std::tie(a.low, a.high, a.face, a.local) < std::tie(b.low, b.high, b.face, b.local);
    });
    std::vector<std::array<int, 2>> outline;
    for (std::size_t i = 0; i < sides.size(); ++i) {
        const auto same = [&](std::size_t j) {
            return j < sides.size() && sides[j].low == sides[i].low && sides[j].high == sides[i].high;
        };
        if (!same(i + 1) && (i == 0 || !same(i - 1))) outline.push_back({sides[i].face, sides[i].local});
    }
    return outline;
}

}  // namespace

// State of the recursive construction over one patch.
struct ClothTree::PatchBuild {
    int patch = 0;
    bool flat = false, convex = false;
    double largest = 0;                        // distance of a corner from its face's centroid [m]
    std::vector<Vec3> middle;                  // per face of the surface
    std::vector<std::array<Vec2, 2>> outline;  // edges of a panel that is not convex
};

ClothTree::ClothTree(TreeSurface surface, double slack)
    : surface_(std::move(surface)), slack_(slack), particles_(int(surface_.group_of.size()))
{
    const std::size_t faces = surface_.faces.size(), corners = std::size_t(particles_) + surface_.body_corners.size();
    order_.resize(faces);
    std::iota(order_.begin(), order_.end(), 0);
    rest_inverse_.resize(faces);
    for (std::size_t f = 0; f < faces; ++f) {
        if (surface_.faces[f][0] < 0) continue;
        const auto& u = surface_.rest[f];
        const Vec2 a = u[1] - u[0], b = u[2] - u[0];
        const double d = a.x() * b.y() - a.y() * b.x();
        rest_inverse_[f] = {b.y() / d, -a.y() / d, -b.x() / d, a.x() / d};
    }
    own_primitives();
    if (!surface_.patches.empty()) build_patches(0, int(surface_.patches.size()));
    start_.resize(corners);
    end_.resize(corners);
    searched_start_.resize(corners);
    searched_end_.resize(corners);
    slack_of_.resize(corners);
    corner_box_.resize(corners);
    edge_box_.resize(edges_.size());
    face_box_.resize(faces);
    face_gradients_.resize(faces);
    node_box_.resize(nodes_.size());
    node_gradients_.resize(nodes_.size());
}

// Lets the first face of each vertex and edge own it, so that every primitive is offered once.
void ClothTree::own_primitives()
{
    struct Side {
        int low, high, face, local;
    };
    std::vector<Side> sides;
    std::vector<char> seen(std::size_t(particles_) + surface_.body_corners.size());
    owned_.assign(surface_.faces.size(), 0);
    own_edges_.assign(surface_.faces.size(), {-1, -1, -1});
    for (int f = 0; f < int(surface_.faces.size()); ++f)
        for (int k = 0; k < 3; ++k) {
            const int a = surface_.faces[f][k], b = surface_.faces[f][(k + 1) % 3];
            if (!seen[slot(a)]) owned_[f] |= std::uint8_t(1 << k);
            seen[slot(a)] = 1;
            sides.push_back({std::min(a, b), std::max(a, b), f, k});
        }
    std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
        return std::tie(a.low, a.high, a.face, a.local) < std::tie(b.low, b.high, b.face, b.local);
    });
    for (std::size_t i = 0; i < sides.size(); ++i)
        if (i == 0 || sides[i].low != sides[i - 1].low || sides[i].high != sides[i - 1].high)
            own_edges_[sides[i].face][sides[i].local] = 0;
    for (std::size_t f = 0; f < own_edges_.size(); ++f)  // numbered in the order in which the faces read them
        for (int k = 0; k < 3; ++k) {
            if (own_edges_[f][k] < 0) continue;
            own_edges_[f][k] = int(edges_.size());
            edges_.push_back({surface_.faces[f][k], surface_.faces[f][(k + 1) % 3]});
        }
}

void ClothTree::build_patches(int first_patch, int patch_count)
{
    if (patch_count > 1) {
        const int at = int(nodes_.size());
        nodes_.push_back({});
        build_patches(first_patch, patch_count / 2);
        const int right = int(nodes_.size());
        build_patches(first_patch + patch_count / 2, patch_count - patch_count / 2);
        nodes_[at].right = right;
        nodes_[at].count = nodes_[at + 1].count + nodes_[right].count;
        return;
    }
    const TreeSurface::Patch& patch = surface_.patches[first_patch];
    PatchBuild build_state;
    build_state.patch = first_patch;
    build_state.flat = patch.flat;
    build_state.convex = patch.convex;
    build_state.middle.resize(surface_.faces.size());
    Cell cell{Vec2::Constant(1e30), Vec2::Constant(-1e30), {}, {}};
    for (int f = patch.first_face; f < patch.first_face + patch.face_count; ++f) {
        Vec3& middle = build_state.middle[f];
        middle.setZero();
        for (int k = 0; k < 3; ++k) {
            if (patch.flat)
                middle.head<2>() += surface_.rest[f][k] / 3;
            else
                middle += surface_.body_corners[-1 - surface_.faces[f][k]] / 3;
        }
        if (!patch.flat) continue;
        cell.faces.push_back(f);
        for (int k = 0; k < 3; ++k) {
            const Vec2& u = surface_.rest[f][k];
            build_state.largest = std::max(build_state.largest, (u - middle.head<2>()).norm());
            cell.low = cell.low.cwiseMin(u);
            cell.high = cell.high.cwiseMax(u);
        }
    }
    if (patch.flat && !patch.convex)
        for (const auto& [f, k] : outline_of(surface_.faces, patch.first_face, patch.face_count)) {
            const Vec2 &a = surface_.rest[f][k], &b = surface_.rest[f][(k + 1) % 3];
            cell.outline.push_back(int(build_state.outline.size()));
            build_state.outline.push_back({a.cwiseMin(b), a.cwiseMax(b)});
        }
    build(build_state, patch.first_face, patch.face_count, cell);
}

// Returns the part of a cell between two corners, with the faces and outline edges that overlap it, enlarged by
// the largest face.
ClothTree::Cell ClothTree::part_of(const PatchBuild& build, const Cell& cell, const Vec2& low, const Vec2& high) const
{
    Cell part{low, high, {}, {}};
    const Vec2 grown_low = low.array() - build.largest, grown_high = high.array() + build.largest;
    for (int f : cell.faces) {
        const auto& u = surface_.rest[f];
        const Vec2 face_low = u[0].cwiseMin(u[1]).cwiseMin(u[2]), face_high = u[0].cwiseMax(u[1]).cwiseMax(u[2]);
        if (overlap(face_low, face_high, grown_low, grown_high)) part.faces.push_back(f);
    }
    for (int e : cell.outline)
        if (overlap(build.outline[e][0], build.outline[e][1], grown_low, grown_high)) part.outline.push_back(e);
    return part;
}

void ClothTree::build(PatchBuild& state, int first, int count, const Cell& cell)
{
    const int at = int(nodes_.size());
    nodes_.push_back({.first = first,
                      .count = count,
                      .patch = state.patch,
                      .may_be_flat = state.flat && (state.convex || cell.outline.empty())});
    if (count <= leaf_faces) {
        nodes_[at].first_near = int(near_.size());
        nodes_[at].near_count = int(cell.faces.size());
        near_.insert(near_.end(), cell.faces.begin(), cell.faces.end());
        return;
    }
    Vec3 low = Vec3::Constant(1e30), high = -low;
    for (int k = first; k < first + count; ++k) {
        low = low.cwiseMin(state.middle[order_[k]]);
        high = high.cwiseMax(state.middle[order_[k]]);
    }
    int axis = 0;
    (high - low).maxCoeff(&axis);
    const auto begin = order_.begin() + first;
    const int half = count / 2;
    std::nth_element(begin, begin + half, begin + count, [&](int a, int b) {
        return std::pair(state.middle[a][axis], a) < std::pair(state.middle[b][axis], b);
    });
    Cell left = cell, right = cell;
    if (state.flat) {
        const double cut = state.middle[order_[first + half]][axis];
        Vec2 left_high = cell.high, right_low = cell.low;
        left_high[axis] = right_low[axis] = cut;
        left = part_of(state, cell, cell.low, left_high);
        right = part_of(state, cell, right_low, cell.high);
    }
    build(state, first, half, left);
    const int right_at = int(nodes_.size());
    build(state, first + half, count - half, right);
    nodes_[at].right = right_at;
}

}  // namespace selvage
