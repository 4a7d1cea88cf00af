#pragma once
#include <array>
#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include "host/collision/ccd.hpp"
#include "host/collision/cloth_tree.hpp"
#include "host/mesh/self_intersections.hpp"
#include "host/model/body.hpp"
#include "host/solver/state/state.hpp"
#include "host/solver/state/topology.hpp"
#include "host/solver/terms/params.hpp"

namespace selvage {

/// What a run reports of contact between cloth and cloth.
struct ClothContactCounts {
    long long looks = 0;      ///< Times that pairs were looked for.
    long long shortened = 0;  ///< Moves that were cut since something would have been passed through.
    int inside = 0;           ///< Vertices that started inside a body and are still there.
    int tangles = 0;          ///< Pairs of triangles that intersect and may pass through each other.
};

/// Contact of the cloth with itself, and of its faces and edges with bodies: keeps the pairs in the state's fields up
/// to date and every move free of crossings. Cloth that starts free of intersections stays so, since whatever moves the
/// cloth, the bodies or held vertices asks here first. Vertices on bodies are FabricContact's; here their ways are
/// checked as well.
///
/// Cloth that starts with intersections is tangled: triangles that intersect may pass through each other and through
/// bodies until they are apart; then they are as the others.
class ClothContact {
public:
    static constexpr int memory_size = 16;  ///< Numbers per pair in memory().

    /// @param bodies    those that can be touched; left out are those that cloth is clear of whose vertices are
    /// @param gap       distance at which contact sets in [m]
    /// @param friction  per particle [1]
    ClothContact(const Topology& topology, const Cloth& cloth, const std::vector<Body>& bodies, double gap,
                 std::vector<double> friction);

    /// Looks for intersections that are there at the start.
    void begin(State& state);

    /// Where particles stand still and only the others are looked at. @param is_awake  per particle; null: all move
    void let_sleep(const std::vector<char>* is_awake) { tree_.let_sleep(is_awake); }

    /// Forgets what earlier steps have found, so that a step depends on the state alone and a resumed run goes the same
    /// way.
    void start_step() { tree_.forget(); }

    /// Lists the pairs that are in contact at state.pos.
    void update(State& state);

    /// Shortens a move until its straight way is free: no pair comes nearer than a tenth of its distance or of the gap,
    /// whichever is less. Also lists all pairs that are in contact somewhere on the way.
    /// @param move     planes like pos [m]
    /// @param uniform  true: the whole move is scaled; false: only the vertices around what would be hit are held back
    void clear_way(State& state, std::vector<real>& move, bool uniform);

    /// Returns true if nothing is passed through on the straight ways from `from` (planes like pos) to state.pos.
    bool is_clear_from(State& state, const std::vector<real>& from);

    /// Called with the time up to which bodies have come whenever they move on [s].
    using Carry = std::function<void(State&, double)>;
    void set_carry(Carry carry) { carry_ = std::move(carry); }
    /// Sets where bodies and held particles are to be at the end of a step. @param pins  particle and place [m]
    void aim(const std::vector<std::pair<int, Vec3>>& pins, double time);
    /// Given the moves of held particles, sets those of the others (planes like pos) [m].
    using Follow = std::function<void(std::vector<real>&)>;
    /// Moves them on as far as the cloth makes way; what bodies push or hold by friction goes along with their surface.
    /// @param follow  how the cloth would follow pins
    /// @returns true if they are not there yet
    bool advance_held(State& state, const Follow& follow);
    bool held_up() const { return pending_; }
    /// Puts bodies where they are at a time, at the start or when a step is given up.
    void place_bodies(State& state, double time);

    /// Ends a step for friction: bristles slip, limits follow the normal forces. Tangles that have come apart are
    /// noticed.
    void settle(State& state, const Params& params);

    /// The bristles of friction, for retries and checkpoints.
    std::vector<real>& memory() { return memory_; }
    const std::vector<real>& memory() const { return memory_; }

    /// Per particle: 1 if it belongs to a triangle that a body pierces.
    const std::vector<char>& pierced() const { return pierced_; }

    /// What is known of each particle's faults, for checkpoints: 1 if it started inside a body and is still there, plus
    /// 2 if it belongs to a triangle that may pass through others, plus 4 if a body pierces that.
    std::vector<real> faults() const;
    void set_faults(const std::vector<real>& faults);  ///< As `faults` gave them.

    double gap() const { return gap_; }
    bool is_near_itself() const
    {
        return !tree_.candidates().empty();
    }  ///< Or a body, on the last way that was cleared.
    const ClothContactCounts& counts() const { return counts_; }
    const TreeCounts& tree_counts() const { return tree_.counts(); }
    std::size_t bytes() const;

private:
    struct Look {            // at one candidate
        float distance = 0;  // a lower bound; exact where the candidate may matter [m]
        float approach = 0;  // an upper bound, likewise [m]
        bool near = false;   // it may matter on this way
    };
    struct Way {  // what is about to move, and where from
        const std::vector<real>& pos;
        const std::vector<real>* move = nullptr;  // null: nothing
        const std::vector<Vec3>* body_move = nullptr;
        int stride = 0;
    };

    Vec3 place(int corner, const Way& way) const;
    Vec3 move(int corner, const Way& way) const;
    PairCorners places(const PairCandidate& candidate, const Way& way) const;
    PairCorners moves(const PairCandidate& candidate, const Way& way) const;
    int slot(int corner) const { return corner >= 0 ? corner : int(area_.size()) - 1 - corner; }
    double gap_of(const PairCandidate& candidate) const;
    double least_distance(const PairCandidate& candidate, const Look& look) const;
    bool may_pass(const PairCandidate& candidate) const;

    void cover(const State& state, const Way& way);
    void measure_ways(const Way& way);
    void look_at_all(const State& state, const Way& way, bool afresh);
    float free_part(int candidate, const Way& way, float enough) const;
    std::vector<float> free_parts(const Way& way) const;
    float scale_all(const Way& way) const;
    bool hold_back(std::vector<real>& move, const Way& way, const std::vector<float>& part) const;
    void let_followers_wait(const State& state, const Way& way, std::vector<real>& move);
    void list_pairs(State& state);
    void list_slots(State& state) const;
    void recall(State& state) const;
    void remember(const State& state);
    double area_of(const PairCandidate& candidate, const Way& way) const;
    void find_tangles(const State& state);
    void renew_targets();
    void find_inside(const State& state);
    void show_bodies(State& state) const;
    std::vector<Vec3> ways_of_bodies() const;
    void ride(const State& state, const Way& way, std::vector<real>& move) const;

    double gap_, body_gap_, body_reach_ = 0;
    std::vector<double> friction_, area_;                       // per particle
    std::vector<Face> faces_;                                   // of particles
    std::vector<Body> bodies_;                                  // those in the tree
    std::vector<Vec3> body_now_, body_goal_;                    // corners of all of them [m]
    std::vector<std::pair<int, Vec3>> pins_;                    // where held particles are to be
    int body_version_ = 0;                                      // changes with body_now_
    std::vector<std::unique_ptr<IntersectionTarget>> targets_;  // the bodies, where tangles are looked for
    int targets_version_ = -1;                                  // body_version_ that they are of
    Carry carry_;
    double time_ = 0, goal_time_ = 0;  // where bodies are and are to be [s]
    double keep_, nearest_;            // part of a distance that a move leaves; where it gets scarce [m]
    bool pending_ = false;             // bodies or pins are not where they are to be
    ClothTree tree_;
    std::vector<Look> looks_;                       // per candidate
    std::vector<Vec3> seen_;                        // per corner: where it was at the last look [m]
    std::vector<float> gone_, way_;                 // per corner: how far it has gone since, and is to go [m]
    std::vector<char> tangled_, inside_, pierced_;  // per particle
    std::vector<int> listed_;                       // candidates that are pairs now, in the pairs' order
    std::vector<real> memory_;
    ClothContactCounts counts_;
};

/// The surface of a cloth that a tree is built over, in the numbering of the topology's particles.
TreeSurface tree_surface(const Topology& topology, const Cloth& cloth);

/// Adds the surfaces of bodies to it.
void add_bodies(TreeSurface& surface, const std::vector<Body>& bodies);

}  // namespace selvage
