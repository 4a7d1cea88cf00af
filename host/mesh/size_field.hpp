#pragma once
#include <vector>

#include "io/geometry.hpp"

namespace selvage {

/// The wanted edge length at each point of a panel: the target, but less near short boundary sides,
///     s(x) = min(target, min_i(spacing_i + growth |x - p_i|)).
class SizeField {
public:
    /// @param polygon  closed boundary, sampled; any unit of length
    /// @param target   edge length away from short sides, same unit
    SizeField(const std::vector<Vec2>& polygon, double target);
    double at(const Vec2& point) const;  ///< Wanted edge length at a point, same unit.

private:
    struct Source {
        Vec2 place;
        double spacing;
    };
    void spread_sources();
    double from(int source, const Vec2& point) const;

    double target_;
    std::vector<Source> sources_;  // the samples with short sides
    Vec2 low_;
    double cell_ = 0;
    int columns_ = 0, rows_ = 0;
    std::vector<int> nearest_;  // per grid cell: source of the smallest edge length; -1: not known yet
};

}  // namespace selvage
