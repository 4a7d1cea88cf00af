#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Geometry>

#include "host/parallel/stopwatch.hpp"
#include "io/geometry.hpp"

namespace selvage {

/// Two primitives that may come near each other: a vertex and a face, or two edges. Corners below zero are corners of
/// bodies, -1 - k for corner k; the others are particles.
struct PairCandidate {
    std::array<int, 4> corner{};  ///< A vertex and a face's three, or the ends of two edges.
    bool edges = false;
    float distance = 0;  ///< At the start of the move that it was found for, a lower bound [m].
};

/// The faces over which a tree is built. Faces of bodies have corners below zero; see PairCandidate.
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
    std::vector<Vec3> body_corners;  ///< Positions of the bodies' corners at first [m].
};

/// The corners of all bodies at a time.
struct TreeBodies {
    const std::vector<Vec3>& corners;          ///< [m]
    const std::vector<Vec3>* moves = nullptr;  ///< Their straight displacements [m]; null: they stand still.
    int version = 0;                           ///< Changes whenever the corners do.
};

/// What a tree takes from one call of cover to the next.
struct TreeMemory {
    bool valid = false;                     ///< The candidates may be complete for the next move as well.
    std::vector<Vec3> start, end;           ///< Of each particle in the searched move, in the moving frame [m].
    std::vector<float> slack;               ///< Of each particle [m].
    std::vector<int> skipped;               ///< Subtrees that the search skipped as flat.
    std::vector<PairCandidate> candidates;  ///< In their order.
    std::vector<PairCandidate> asleep;      ///< Those all of whose corners sleep.
    int partial = 0;                        ///< Partial searches since the last one for all corners.
};

struct SearchCounts {
    long long searches = 0;  ///< Traversals.
    long long measured = 0;  ///< Pairs whose distance they measured.
    TimeSpent spent;         ///< In them.
};

struct TreeCounts {
    SearchCounts whole;          ///< For all corners.
    SearchCounts partial;        ///< Only for those that had left their searched moves.
    long long reused = 0;        ///< Calls in which the last candidates were proved to be still complete.
    long long flat_skipped = 0;  ///< Subtrees that traversals skipped since they cannot meet themselves.
};

/// A bounding volume hierarchy over the faces of the cloth and of the bodies that it may touch. Every node has one box
/// for either end of a move. The tree finds all pairs of primitives that can come within a distance during the move.
///
/// All corners move along straight lines at the same time. The lowest coordinate of a primitive is then a concave
/// function of time, and the highest a convex one. Two primitives that are separated along an axis in the same order at
/// both ends are therefore separated during the whole move, however far they move together.
///
/// Flat parts are skipped. Take two points of a convex piece of a panel at rest distance r, with F the deformation
/// gradient (3x2) of its faces. Their distance in space is at least (s - e) r, where s is the smaller singular value of
/// some F0 and e bounds |F - F0| over the piece, since the path between them is straight at rest and
///     |x(a) - x(b)| = |integral F dr| >= |F0 (a - b)| - e |a - b|.
/// So a subtree whose s - e is above a threshold cannot meet itself, also not along its outline. F is linear in the
/// positions, so ranges of F that include both ends of a move hold during the whole move. This is a rigorous form of
/// the test on cones of normals.
///
/// A new move needs no search under two conditions. First, at its start, and again at its end, every corner is within
/// its slack of its position at some moment of the searched move, which is the same moment for all corners; positions
/// are relative to a frame that moves with the cloth. Second, every skipped subtree still passes the test of flatness.
///
/// Where only some corners fail, a partial search looks for the pairs of these alone. The searched moves of the others
/// are cut to the part that they make now, so that one moment is again the same for all corners: what keeps apart on a
/// move keeps apart on a part of it, so pairs without a marked corner need not be looked at.
class ClothTree {
public:
    /// @param slack  distance by which corners may deviate from the searched move without a new search [m]
    ClothTree(TreeSurface surface, double slack);

    /// Makes candidates complete for the straight moves from `from` to `from + move` of all particles.
    /// @param reach       distance within which pairs of cloth primitives are candidates [m]
    /// @param from, move  planes, component c of particle v at [c * stride + v] [m]; move may be null: no move
    /// @param bodies      positions and moves of the bodies
    /// @param body_reach  the same for a primitive of the cloth and one of a body, at most reach [m]
    /// @returns true if the candidates have changed
    bool cover(const double* from, const double* move, int stride, const TreeBodies& bodies, double reach,
               double body_reach);

    /// From the next call of cover on searches only for pairs with an awake corner. Candidates whose corners all sleep
    /// are kept, so these corners, and those of bodies, must not move.
    /// @param is_awake  per particle; null: all are awake
    void let_sleep(const std::vector<char>* is_awake);

    const std::vector<PairCandidate>& candidates() const { return candidates_; }
    /// Where the first candidates stood before the last call of cover that changed them; the others are new.
    const std::vector<int>& kept_from() const { return kept_from_; }
    const TreeCounts& counts() const { return counts_; }
    std::size_t body_corner_count() const { return start_.size() - std::size_t(particles_); }
    void forget() { valid_ = false; }  ///< Makes the next call of cover search.
    /// For checkpoints. @param bodies  where they are now: what was searched with them elsewhere is not valid
    TreeMemory memory(const TreeBodies& bodies) const;
    /// Takes over a memory. The last call of cover must have been for the present place, with these bodies.
    /// @throws std::invalid_argument if it is of another surface
    void set_memory(TreeMemory memory);
    std::size_t bytes() const;
    /// What a tree of so many faces and corners will take, but for its candidates [bytes].
    static std::size_t bytes_of(std::size_t faces, std::size_t corners);

private:
    struct Sweep {  // boxes at both ends of a move; the fourth component is padding, 0 unless empty
        using Corner = Eigen::Array4f;
        std::array<Corner, 2> low, high;
        void clear();
        void add(const Sweep& other);
        bool meets(const Sweep& other) const  // false: they are separated during the whole move
        {
            const Corner above = (low[0] - other.high[0]).min(low[1] - other.high[1]);
            const Corner below = (other.low[0] - high[0]).min(other.low[1] - high[1]);
            return above.max(below).maxCoeff() <= 0;
        }
    };
    struct Gradients {  // range of the deformation gradients F, column by column
        std::array<float, 6> low, high;
        void clear();
        void add(const Gradients& other);
        double stretch_bound() const;  // s - e
    };
    struct Node {
        int right = 0;                       // second child, the first comes next; 0: a leaf
        int first = 0, count = 0;            // its faces, in tree order
        int patch = -1;                      // of its faces; -1: several
        bool may_be_flat = false;            // its piece of the panel is convex
        int first_near = 0, near_count = 0;  // leaves: range of near_
    };
    using NodePair = std::array<int, 2>;
    static constexpr int leaf_faces = 4;  // at most; affects speed only; chosen by hand, not measured
    struct Findings {                     // of a piece of a traversal
        std::vector<PairCandidate> candidates;
        std::vector<int> skipped;  // nodes
        long long measured = 0;    // pairs
    };
    struct FacesNear {
        std::array<int, leaf_faces> face;
        int count = 0;
    };
    struct Cell {  // rectangle of a panel that a node covers, and what overlaps it
        Vec2 low, high;
        std::vector<int> faces, outline;  // outline: indices into PatchBuild::outline
    };
    struct PatchBuild;

    void build_patches(int first_patch, int patch_count);
    void build(PatchBuild& build, int first, int count, const Cell& cell);
    Cell part_of(const PatchBuild& build, const Cell& cell, const Vec2& low, const Vec2& high) const;
    void own_primitives();
    void set_frame(const double* from, const double* move, int stride, const TreeBodies& bodies);
    enum class Unknown { nothing, marked, all };
    enum Mark : char { deviates = 1, was_skipped = 2 };
    Unknown mark_unknown();
    void search_anew(int k, bool still);
    double fitted_fraction(const std::vector<Vec3>& at) const;
    void add_gradient(Gradients& range, int face, const std::array<Vec3, 3>& corners) const;
    bool lies_flat(const double* from, const double* move, int stride) const;
    void refit_gradients(bool skipped_only);
    void refit_boxes(bool bodies_move, bool bodies_too);
    void search_all();
    void search_marked();
    void traverse(SearchCounts& counts);
    void note_skipped();
    /// Flags nodes by the faces below them: where all are flagged, or any.
    void flag_nodes(const std::vector<char>& faces, bool all, std::vector<char>& nodes) const;
    void visit(NodePair pair, std::vector<NodePair>& stack, Findings& found) const;
    FacesNear faces_near(const Node& leaf, const Sweep& box) const;
    void offer_pairs(int face_a, int face_b, Findings& found) const;
    void offer(const PairCandidate& candidate, Findings& found) const;
    bool may_touch(const PairCandidate& candidate) const;
    bool sleeps(int corner) const { return corner < 0 || !is_awake_[corner]; }
    bool sleeps(const PairCandidate& candidate) const
    {
        return std::all_of(candidate.corner.begin(), candidate.corner.end(), [this](int c) { return sleeps(c); });
    }
    void add_sleeping_candidates();
    bool is_marked(int corner) const { return corner >= 0 && marks_[corner]; }
    bool is_marked(const PairCandidate& candidate) const
    {
        return std::any_of(candidate.corner.begin(), candidate.corner.end(), [this](int c) { return is_marked(c); });
    }
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
    std::vector<int> near_;                      // per leaf: faces that overlap its cell, enlarged by the largest face
    std::vector<std::uint8_t> owned_;            // per face: bits 0-2 mark the corners that it owns
    std::vector<std::array<int, 3>> own_edges_;  // per face: the edges that it owns, -1 where another face does
    std::vector<std::array<int, 2>> edges_;      // corners of each edge
    std::vector<std::array<double, 4>> rest_inverse_;

    std::vector<Vec3> start_, end_;                    // of each corner in the moving frame, particles first
    std::vector<Vec3> searched_start_, searched_end_;  // the same of the moves that the candidates are complete for
    std::vector<float> slack_of_;                      // of each corner [m]
    std::vector<Sweep> corner_box_, edge_box_, face_box_, node_box_;
    std::vector<Gradients> face_gradients_, node_gradients_;
    std::vector<int> skipped_;  // nodes skipped as flat
    // Of a partial search: why particles are looked at, and what has such corners.
    std::vector<char> marks_, face_marks_, node_marks_;
    std::vector<char> node_skipped_;               // per node, in a partial search
    std::vector<char> in_skipped_, near_skipped_;  // nodes of skipped subtrees, and the faces whose gradients they need
    std::vector<int> kept_from_;
    int partial_since_ = 0;       // partial searches since the last one for all corners
    bool partial_ = false;        // the search that runs
    std::vector<char> is_awake_;  // per particle; empty: all are
    std::vector<char> face_sleeps_, node_sleeps_;
    std::vector<PairCandidate> asleep_;  // candidates all of whose corners sleep
    double reach_ = 0, body_reach_ = 0;
    int body_version_ = -1;
    bool valid_ = false;
    std::vector<PairCandidate> candidates_;
    TreeCounts counts_;
};

}  // namespace selvage
