#pragma once
#include <string>
#include <vector>

#include "host/model/cloth_model.hpp"
#include "io/geometry.hpp"

namespace selvage {

struct Scene;

/// The cloth and the bodies of a scene, assembled; what was odd but usable is in `findings`.
struct SceneModel {
    ClothModel cloth_model;
    std::vector<Finding> findings;
    bool sews = false;          ///< There are seams to close before draping.
    bool body_between = false;  ///< A mesh body stands between the two sides of a seam.
    double edge_length = 0.01;  ///< Typical rest edge of the finest cloth [m].
};

/// Reads, meshes and places everything that a scene names.
/// @throws InputError for any fault of a pattern, mesh, measure or resolution
SceneModel build_scene_model(const Scene& scene);

/// Returns the same scene with its cloth as level `level` of cloth_model.coarser has it, and what is coarser than that.
SceneModel coarser_model(const SceneModel& model, std::size_t level);

/// Returns the memory that a run of the scene may take: solver.memory_limit, or most of the machine's [bytes].
double memory_limit(const Scene& scene);

/// Returns where the cloth may go: its start box grown by its own size.
Box cloth_reach(const Cloth& cloth);

}  // namespace selvage
