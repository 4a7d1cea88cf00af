#pragma once
#include <cstdint>
#include <vector>

#include "host/mesh/self_intersections.hpp"
#include "host/model/cloth_model.hpp"
#include "host/solver/stepping/phase.hpp"
#include "io/run/summary.hpp"

namespace selvage {

/// What crosses in the last frame of a run, as the frame is written.
struct EndCrossings {
    bool counted = false;         ///< False: a position is infinite or no number.
    std::vector<Vec3> positions;  ///< Of the cloth's vertices, as written [m].
    std::vector<IntersectingPair> self;
    std::vector<std::vector<IntersectingPair>> with_body;  ///< For each body: a triangle of the cloth and one of it.

    std::int64_t count_with_bodies() const;
};

/// Returns what is to be said of triangles that cross at the end: how many, where the first is, and why.
std::vector<Finding> find_end_crossings(const ClothModel& model, const EndCrossings& crossings);

/// Where a garment has come to, against gravity's direction.
struct GarmentFall {
    double height = 0;            ///< Of the garment at its start, along gravity [m].
    double fall = 0;              ///< Of its middle since then [m].
    std::vector<bool> touches{};  ///< For each body, whether the garment touches it at the end.
};

/// Returns what is to be said of a garment that hangs on none of its bodies: it slid off, or never was on one. Planes
/// are floors and walls, which no garment is worn on. Nothing without such bodies.
std::vector<Finding> find_lost_garment(const ClothModel& model, const GarmentFall& fall);

/// The same, measured at the end of a phase; nothing for cloth that is no garment.
/// @param positions  per cloth vertex [m]
std::vector<Finding> find_lost_garment(const ClothModel& model, const Phase& phase, const std::vector<Vec3>& positions);

/// Returns what is to be said of a motion whose steps are long for it: nothing, or the one that errs most, by the
/// integrator's own estimate.
/// @param positions  per cloth vertex, whose extent the error is compared with [m]
std::vector<Finding> find_long_steps(const MotionAccuracy& accuracy, const std::vector<Vec3>& positions);

/// Of what was found before a run, that which explains an end that is not as asked.
/// @param complete  the run came to its asked end   @param at_end  what was found there
std::vector<Finding> findings_that_mattered(const std::vector<Finding>& before, bool complete,
                                            const std::vector<Finding>& at_end);

}  // namespace selvage
