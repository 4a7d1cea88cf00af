#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Geometry>

#include "io/geometry.hpp"

namespace selvage {

/// Two primitives that may come near each other: a vertex and a face, or two edges. Corners below zero are corners of
/// bodies, -1 - k for corner k; the others are particles.
struct PairCandidate {
    std::array<int, 4> corner{};  ///< A vertex and a face's three, or the ends of two edges.
    bool edges = false;
    float distance = 0;  ///< Where the search found it: a lower bound, exact but for rounding [m].
};

/// What a tree is built over. Faces of bodies have corners below zero; see PairCandidate.
struct TreeSurface {
    struct Patch {  ///< A panel of the cloth, or a body.
        int first_face = 0, face_count = 0;
        bool flat = false;    ///< Panels: rest coordinates are given.
        bool convex = false;  ///< The panel's outline is convex.
    };
    std::vector<Face> faces;
    std::vector<std::array<Vec2, 3>> rest;  ///< Panel coordinates of the corners of each face [m]; unused for bodies.
    std::vector<Patch> patches;
    std::vector<int> group_of;       ///< Per particle: particles that are or will be sewn are one group.
    std::vector<Vec3> body_corners;  ///< Where the bodies' corners are at first [m].
};

/// The corners of all bodies at a time.
struct TreeBodies {
    const std::vector<Vec3>& corners;          ///< [m]
    const std::vector<Vec3>* moves = nullptr;  ///< Their straight way [m]; null: they stand still.
    int version = 0;                           ///< Changes whenever the corners do.
};

struct TreeCounts {
    long long searches = 0;      ///< Traversals of the tree.
    long long reused = 0;        ///< Times that the last candidates were proved to be still complete.
    long long flat_skipped = 0;  ///< Subtrees that were skipped in traversals since they cannot meet themselves.
};

/// A bounding volume hierarchy over the faces of the cloth, and of the bodies that it may touch, whose nodes have a box
/// for each end of a move. It finds all pairs of primitives that can come within a distance during the move.
///
/// Corners go straight and at the same time, so that the lowest corner of a side is above the chord of its lowest at
/// both ends: two sides that are apart along the same axis in the same order at both ends are so all the way, however
/// far they go together.
///
/// Flat parts are skipped (E7). Between two points of a convex piece of a panel at rest distance r, with F the
/// deformation gradient (3x2) of its faces, the distance in space is at least (s - e) r, where s is the smaller
/// singular value of some F0 and e bounds |F - F0| over the piece: the path between them is straight at rest and
///     |x(a) - x(b)| = |integral F dr| >= |F0 (a - b)| - e |a - b|.
/// So a subtree whose s - e is above a threshold cannot meet itself, which also covers its outline, and since F is
/// linear in the positions, checking both ends of a move covers the move. This is a rigorous form of the test on
/// cones of normals.
///
/// Candidates stay complete while every corner begins and ends within its slack of where the searched move has it at a
/// moment that all have in common, in a frame that moves along with the cloth, and while every skipped subtree still
/// passes the test.
class ClothTree {
public:
    /// @param slack  how far corners may stray from the searched move before it has to be searched again [m]
    ClothTree(TreeSurface surface, double slack);

    /// Makes candidates complete for the straight moves from `from` to `from + move` of all particles.
    /// @param reach       distance of primitives that is of interest [m]
    /// @param from, move  planes, component c of particle v at [c * stride + v] [m]; move may be null: no move
    /// @param bodies       where the bodies are
    /// @param body_reach   the same for a primitive of the cloth and one of a body, at most reach [m]
    /// @returns true if the candidates have changed
    bool cover(const double* from, const double* move, int stride, const TreeBodies& bodies, double reach,
               double body_reach);

    /// From here on looks only at what has an awake corner, until told otherwise. What is known of the others stays
    /// known: their corners, and those of bodies, must stand still. @param is_awake  per particle; null: all are
    void let_sleep(const std::vector<char>* is_awake);

    const std::vector<PairCandidate>& candidates() const { return candidates_; }
    const TreeCounts& counts() const { return counts_; }
    void forget() { valid_ = false; }  ///< The next call of cover searches.
    std::size_t bytes() const;

private:
    struct Sweep {  // boxes at both ends of a move; a fourth component, 0 if not empty, pads them
        using Corner = Eigen::Array4f;
        std::array<Corner, 2> low, high;
        void clear();
        void add(const Sweep& other);
        bool meets(const Sweep& other) const  // false: they are apart all the way
        {
            const Corner above = (low[0] - other.high[0]).min(low[1] - other.high[1]);
            const Corner below = (other.low[0] - high[0]).min(other.low[1] - high[1]);
            return above.max(below).maxCoeff() <= 0;
        }
    };
    struct Gradients {  // range of the deformation gradients, F by columns
        std::array<float, 6> low, high;
        void clear();
        void add(const Gradients& other);
        double stretch_bound() const;  // s - e
    };
    struct Node {
        int right = 0;                       // second child, the first comes next; 0: a leaf
        int first = 0, count = 0;            // its faces, in tree order
        int patch = -1;                      // -1: several
        bool may_be_flat = false;            // its piece of the panel is convex
        int first_near = 0, near_count = 0;  // leaves: faces that overlap its cell, grown by the largest face
    };
    using NodePair = std::array<int, 2>;
    static constexpr int leaf_faces = 4;  // at most
    struct FacesNear {
        std::array<int, leaf_faces> face;
        int count = 0;
    };
    struct Cell {  // rectangle of a panel that a node stands for, and what overlaps it
        Vec2 low, high;
        std::vector<int> faces, outline;  // outline: index into outline_
    };
    struct PatchBuild;

    void build_patches(int first_patch, int patch_count);
    void build(PatchBuild& build, int first, int count, const Cell& cell);
    Cell part_of(const PatchBuild& build, const Cell& cell, const Vec2& low, const Vec2& high) const;
    void own_primitives();
    void set_frame(const double* from, const double* move, int stride, const TreeBodies& bodies);
    bool still_complete(const TreeBodies& bodies, double reach, double body_reach) const;
    double part_gone(const std::vector<Vec3>& at) const;
    void add_gradient(Gradients& range, int face, const std::array<Vec3, 3>& corners) const;
    bool lies_flat(const double* from, const double* move, int stride) const;
    void refit_gradients();
    void refit_boxes(bool bodies_move, bool bodies_too);
    void search();
    void visit(NodePair pair, std::vector<NodePair>& stack, std::vector<int>& skipped,
               std::vector<PairCandidate>& found) const;
    FacesNear faces_near(const Node& leaf, const Sweep& box) const;
    void meet(int face_a, int face_b, std::vector<PairCandidate>& found) const;
    void offer(const PairCandidate& candidate, std::vector<PairCandidate>& found) const;
    bool may_touch(const PairCandidate& candidate) const;
    bool sleeps(int corner) const { return corner < 0 || !is_awake_[corner]; }
    bool sleeps(const PairCandidate& candidate) const
    {
        return std::all_of(candidate.corner.begin(), candidate.corner.end(), [this](int c) { return sleeps(c); });
    }
    void keep_asleep();
    int slot(int corner) const { return corner >= 0 ? corner : particles_ - 1 - corner; }
    bool is_body(int node) const { return nodes_[node].patch >= 0 && !surface_.patches[nodes_[node].patch].flat; }
    bool is_flat(int node, double threshold) const
    {
        return nodes_[node].may_be_flat && node_gradients_[node].stretch_bound() > threshold;
    }

    TreeSurface surface_;
    double slack_;
    int particles_ = 0;
    std::vector<int> order_;                     // tree order to face
    std::vector<Node> nodes_;                    // children behind their parents
    std::vector<int> near_;                      // faces, see Node
    std::vector<std::uint8_t> owned_;            // per face: bits 0-2 its corners that it stands for
    std::vector<std::array<int, 3>> own_edges_;  // per face: its edges that it stands for, -1 where another face does
    std::vector<std::array<int, 2>> edges_;      // their corners
    std::vector<std::array<double, 4>> rest_inverse_;

    std::vector<Vec3> start_, end_;                    // of each corner in the moving frame, particles first
    std::vector<Vec3> searched_start_, searched_end_;  // the same when the candidates were searched
    std::vector<float> slack_of_;                      // of each corner [m]
    std::vector<Sweep> corner_box_, edge_box_, face_box_, node_box_;
    std::vector<Gradients> face_gradients_, node_gradients_;
    std::vector<int> skipped_;    // nodes that were taken for flat
    std::vector<char> is_awake_;  // per particle; empty: all are
    std::vector<char> face_sleeps_, node_sleeps_;
    std::vector<PairCandidate> asleep_;  // candidates all of whose corners stand still
    double reach_ = 0, body_reach_ = 0;
    int body_version_ = -1;
    bool valid_ = false;
    std::vector<PairCandidate> candidates_;
    TreeCounts counts_;
};

}  // namespace selvage
