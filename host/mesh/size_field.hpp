#pragma once
#include <vector>

#include "io/geometry.hpp"

namespace selvage {

/// The edge length wanted at each place of a panel: the target, but shorter near short boundary sides,
///     s(x) = min(target, min_i(spacing_i + growth |x - p_i|)).
class SizeField {
public:
    /// @param polygon  closed boundary, sampled; any unit of length
    /// @param target   edge length away from short sides, same unit
    SizeField(const std::vector<Vec2>& polygon, double target);
    double at(const Vec2& point) const;

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
    std::vector<int> nearest_;  // the deciding source of each cell of a grid; -1 before it is known
};

}  // namespace selvage
