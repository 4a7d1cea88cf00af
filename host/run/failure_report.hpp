#pragma once
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "host/scene/scene_model.hpp"
#include "host/solver/stepping/integrator.hpp"
#include "host/solver/stepping/phase.hpp"
#include "host/solver/stepping/step_failure.hpp"

namespace selvage {

/// What a run that does not end as asked tells: one line each.
struct FailureReport {
    std::string what;   ///< With the simulated time.
    std::string where;  ///< Vertex, panel, position, bodies; may be empty.
    std::string cause;  ///< The likely one; may be empty.
    std::string cure;   ///< With the keys to turn; may be empty.
};

/// Returns the report as lines of text.
std::string describe(const FailureReport& report);

/// A body as seen from a place in the cloth.
struct BodyAt {
    std::string name;
    double distance = 0;  ///< Of its surface [m].
    double speed = 0;     ///< Of its fastest point [m/s].
    double friction = 0;  ///< [1]
};

/// A vertex of the cloth that a report names.
struct VertexAt {
    std::string name;  ///< See describe_vertex.
    bool held = false;
};

/// What is known where no step succeeds.
struct DivergenceFacts {
    std::string stage = {};  ///< See RunStage.
    double time = 0;         ///< Of the last good state [s].
    StepFailure step = {};
    std::vector<VertexAt> vertices = {};  ///< Of either side of the obstacle, or the one of the failure.
    std::vector<BodyAt> bodies = {};      ///< All, the nearest first.
    double gap = 0;                       ///< At which contact with bodies sets in [m].
    double stretch = 0;                   ///< The largest at the last good state [1].
    std::string stretched = {};           ///< The triangle that has it.
    bool holds = false;                   ///< Vertices are held.
    bool pins_move = false;               ///< And move.
    bool is_explicit = false;             ///< The integrator is.
    int crossings = 0;                    ///< Pairs of triangles that intersect, and vertices inside bodies.
};

FailureReport explain(const DivergenceFacts& facts);

/// What is known where the cloth has not come to rest in its time.
struct UnrestFacts {
    double time = 0;                  ///< [s]
    double residual = 0, asked = 0;   ///< [1]
    std::string pulled = {};          ///< The vertex with the most net force.
    double net_force = 0;             ///< On it [N].
    std::string fastest = {};         ///< The vertex that moves most.
    double speed = 0;                 ///< Of it [m/s].
    std::vector<BodyAt> bodies = {};  ///< As seen from the pulled vertex, the nearest first.
    double gap = 0;                   ///< At which contact with bodies sets in [m].
    int crossings = 0;                ///< Pairs of triangles that still intersect, and vertices inside bodies.
};

FailureReport explain(const UnrestFacts& facts);

/// What is known of the seams that have not closed, above all of the one that is open most.
struct OpenSeamFacts {
    double time = 0;                  ///< At which they were given up [s].
    std::string sides[2] = {};        ///< Panel and edge of both.
    double lengths[2] = {0, 0};       ///< [m]
    std::string ends[2] = {};         ///< The vertices of the pair that is furthest apart.
    double gap = 0;                   ///< Between them [m].
    std::vector<BodyAt> bodies = {};  ///< As seen from half-way between them, the nearest first.
    std::string place = {};           ///< Of the stitch in the pattern.
    /// A seam that is open less.
    struct Other {
        std::array<std::string, 2> sides;  ///< Panel and edge.
        double gap = 0;                    ///< [m]
        std::string place;                 ///< Of the stitch in the pattern.
    };
    std::vector<Other> others = {};
};

FailureReport explain(const OpenSeamFacts& facts);

/// The facts, from where a phase has stopped.
DivergenceFacts divergence_facts(const SceneModel& model, const Phase& phase, const std::string& stage,
                                 const StepFailure& failure, const IntegratorInfo& integrator);
UnrestFacts unrest_facts(const SceneModel& model, const Phase& phase, double residual, double asked);
/// @param time  at which the seams were given up [s]
OpenSeamFacts open_seam_facts(const SceneModel& model, const Phase& phase, double time);

}  // namespace selvage
