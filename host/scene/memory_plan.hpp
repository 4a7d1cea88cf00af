#pragma once
#include <cstddef>
#include <string>
#include <vector>

#include "host/scene/scene_model.hpp"
#include "host/solver/state/topology.hpp"
#include "host/solver/terms/params.hpp"
#include "io/scene/scene.hpp"

namespace selvage {

/// A part of a run that takes memory.
struct MemoryPart {
    std::string name;
    std::size_t bytes = 0;
};

std::size_t total_bytes(const std::vector<MemoryPart>& parts);

/// A phase of a cloth as far as its memory goes; what it refers to must outlive it.
struct PhaseMemory {
    const ClothModel& model;
    const Topology& topology;
    const mesh_sizes& size;
    FieldSet fields;
    const Params& params;
    std::size_t solver_bytes = 0;  ///< See linear_solver_bytes.
};

/// Returns what a phase takes, from the sizes of what it allocates. How many pairs will be in contact is not known
/// before the run: room for one for each vertex is counted.
std::vector<MemoryPart> phase_memory(const PhaseMemory& phase);

/// Returns what the end of a run takes while its phase is still there: the largest of what is made one after the other.
std::vector<MemoryPart> end_memory(const Scene& scene, const ClothModel& model);

/// Returns what this process holds now, the program and the scene's model among it.
MemoryPart present_memory();

}  // namespace selvage
