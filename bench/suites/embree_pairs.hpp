#pragma once
#include <memory>

#include "host/collision/body_bvh.hpp"
#include "host/collision/cloth_tree.hpp"

namespace selvage {

/// The faces of a cloth as user geometry of the ray tracing library, met with themselves by its rtcCollide: the broad
/// phase that ClothTree is measured against. It knows nothing of flat parts and keeps nothing from look to look.
class EmbreePairs {
public:
    enum class Update { refit, rebuild };  ///< Boxes are fitted in the tree that is there, or a new one is built.

    /// @param surface  without bodies
    EmbreePairs(const EmbreeDevice& device, TreeSurface surface, Update update);
    ~EmbreePairs();
    EmbreePairs(const EmbreePairs&) = delete;
    EmbreePairs& operator=(const EmbreePairs&) = delete;

    /// Takes over positions and brings the hierarchy up to date; the first time it is built.
    /// @param pos    planes, component c of particle v at [c * stride + v] [m]
    /// @param reach  distance of primitives that is of interest [m]
    void move(const double* pos, int stride, double reach);

    /// Returns the pairs of primitives whose boxes, grown by half of the reach, overlap, in no particular order; those
    /// of one group of particles are left out, as ClothTree does.
    std::vector<PairCandidate> candidates() const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace selvage
