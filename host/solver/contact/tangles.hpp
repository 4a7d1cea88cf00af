#pragma once
#include <memory>
#include <vector>

#include "host/collision/cloth_tree.hpp"
#include "host/mesh/self_intersections.hpp"
#include "host/model/body.hpp"
#include "host/solver/contact/crossing_flags.hpp"
#include "host/solver/state/state.hpp"

namespace selvage {

/// What already crosses when a phase starts, and how it is let go: triangles that intersect may pass through each other
/// and through bodies, and vertices inside a body may come out of it, until they are apart. Nothing becomes tangled or
/// inside later on, since steps are filtered: what is apart once stays so.
class Tangles {
public:
    /// @param faces  of particles   @param bodies  must outlive this object
    Tangles(std::vector<Face> faces, int particle_count, const std::vector<Body>& bodies);

    /// Finds all that crosses at state.pos. Vertices inside bodies are those below the contact planes of the state.
    /// @param body_corners  of all bodies, in their order
    void find(const State& state, const TreeBodies& body_corners);
    /// Looks again at what still crosses, and lets go of what has come apart.
    void update(const State& state, const TreeBodies& body_corners);

    const CrossingFlags& flags() const { return flags_; }
    /// Takes over flags of a checkpoint. @param flags  of as many particles
    void set_flags(CrossingFlags flags);

    int inside_count() const { return inside_count_; }  ///< Vertices inside bodies.
    /// Pairs of triangles that intersect; after set_flags, particles of such until the next update.
    int tangle_count() const { return tangle_count_; }

private:
    void find_inside(const State& state);
    void find_intersections(const State& state, const TreeBodies& body_corners);
    void renew_targets(const TreeBodies& body_corners);

    std::vector<Face> faces_;
    const std::vector<Body>& bodies_;
    std::vector<std::unique_ptr<IntersectionTarget>> targets_;  // the bodies' meshes
    int targets_version_ = -1;                                  // version of the corners that they are of
    CrossingFlags flags_;
    int inside_count_ = 0, tangle_count_ = 0;
};

}  // namespace selvage
