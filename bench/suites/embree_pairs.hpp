#pragma once
#include <memory>

#include "host/collision/body_bvh.hpp"
#include "host/collision/cloth_tree.hpp"

namespace selvage {

/// A broad phase by Embree's rtcCollide, which collides the faces of a cloth, as user geometry, with themselves.
/// ClothTree is measured against it. Unlike ClothTree it does not skip flat parts of the cloth, and it does not reuse
/// the candidates of the previous query.
class EmbreePairs {
public:
    enum class Update { refit, rebuild };  ///< Refit the boxes of the existing tree, or build a new tree.

    /// @param surface  without bodies
    EmbreePairs(const EmbreeDevice& device, TreeSurface surface, Update update);
    ~EmbreePairs();
    EmbreePairs(const EmbreePairs&) = delete;
    EmbreePairs& operator=(const EmbreePairs&) = delete;

    /// Copies positions and updates the hierarchy; the first call builds it.
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
