#pragma once
#include <memory>
#include <vector>

#include "host/collision/body_query.hpp"
#include "host/model/body.hpp"
#include "host/solver/contact/cloth_body_contact.hpp"
#include "host/solver/linear/linear_solver.hpp"
#include "host/solver/state/snapshot.hpp"
#include "host/solver/state/state.hpp"
#include "host/solver/state/topology.hpp"
#include "host/solver/terms/params.hpp"

namespace selvage {

/// A cloth on which every term and every stage has work to do: a square metre of crumpled cloth that clings to a dome
/// (a mesh of 82 000 triangles), each particle within the contact gap, half of them slipping, with stitches between
/// every twentieth vertex and one nearby. It moves.
class KernelCloth {
public:
    /// @param vertex_count  about as many vertices, >= 16
    explicit KernelCloth(int vertex_count);
    KernelCloth(const KernelCloth&) = delete;
    KernelCloth& operator=(const KernelCloth&) = delete;

    /// Puts positions, velocities and contacts back to the start.
    void reset();

    Params params;  ///< All strengths non-zero.
    State state;
    std::vector<Body> bodies;
    std::unique_ptr<BodyQuery> query;
    std::shared_ptr<ClothBodyContact> contact;
    BlockPattern pattern;
    ParticleProlongations prolongations;                    ///< Of the multigrid levels.
    std::unique_ptr<LinearSolver> block_jacobi, multigrid;  ///< In double, as by default.

private:
    void make_bodies();
    void lay_on_dome(const Cloth& cloth, std::vector<Vec3>& positions, std::vector<Vec3>& velocities) const;
    void connect_levels(const Cloth& cloth, const Topology& topology, int resolution);
    void load_friction();
    void put_pairs();

    Snapshot start_;
};

}  // namespace selvage
