#pragma once
#include <algorithm>
#include <vector>

#include "host/collision/cloth_tree.hpp"

namespace selvage {

/// True if one side of the pair is a body's.
inline bool has_body(const PairCandidate& candidate) { return std::min(candidate.corner[0], candidate.corner[3]) < 0; }

/// Which particles belong to what already crosses something, and so may pass through it until it is apart. Per
/// particle, 0 or 1.
struct CrossingFlags {
    std::vector<char> inside;   ///< It started inside a body and is still there.
    std::vector<char> tangled;  ///< A triangle around it intersects another one or a body.
    std::vector<char> pierced;  ///< A triangle around it intersects a body.

    explicit CrossingFlags(std::size_t particles = 0) : inside(particles), tangled(particles), pierced(particles) {}
    bool operator==(const CrossingFlags&) const = default;

    /// Whether a pair may pass through each other: cloth on the wrong side of something has to get out again.
    bool may_cross(const PairCandidate& candidate) const
    {
        bool all_tangled = true, any_inside = false;
        for (int v : candidate.corner) {
            if (v < 0) continue;
            all_tangled = all_tangled && tangled[v];
            any_inside = any_inside || inside[v];
        }
        return all_tangled || (any_inside && has_body(candidate));
    }
};

}  // namespace selvage
