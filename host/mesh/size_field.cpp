#include "host/mesh/size_field.hpp"

#include <algorithm>
#include <cmath>

namespace selvage {
namespace {

// Chosen by hand, not measured one by one; the unit test of the angles and edges of panel meshes checks what the values
// achieve together with those of the mesher.
struct SizeFieldTuning {
    static constexpr double growth = 0.35;     // slope of the edge length over the distance [1]
    static constexpr double short_side = 0.9;  // sides longer than this times the target do not grade the mesh [1]
    // Least ratio of the edge length at a point to the longer of its two sides [1]. A single short side then gets
    // triangles with one short edge, which is better than many small triangles along its long neighbours.
    static constexpr double min_side_ratio = 0.4;
    static constexpr double cells_per_target = 8;  // target over the least cell width [1]
    static constexpr double max_cells = 4e6;       // of the grid: 16 MB
};

}  // namespace

SizeField::SizeField(const std::vector<Vec2>& polygon, double target) : target_(target), low_(polygon.front())
{
    Vec2 high = low_;
    double shortest = target;
    const std::size_t count = polygon.size();
    for (std::size_t i = 0; i < count; ++i) {
        low_ = low_.cwiseMin(polygon[i]);
        high = high.cwiseMax(polygon[i]);
        const double ahead = (polygon[i] - polygon[(i + 1) % count]).norm();
        const double behind = (polygon[i] - polygon[(i + count - 1) % count]).norm();
        const double spacing =
            std::max(std::min(ahead, behind), SizeFieldTuning::min_side_ratio * std::max(ahead, behind));
        if (spacing < SizeFieldTuning::short_side * target) sources_.push_back({polygon[i], spacing});
        shortest = std::min(shortest, spacing);
    }
    if (sources_.empty()) return;
    const Vec2 extent = high - low_;
    cell_ = std::max({shortest, target / SizeFieldTuning::cells_per_target,
                      std::sqrt(extent.x() * extent.y() / SizeFieldTuning::max_cells)});
    columns_ = int(extent.x() / cell_) + 1;
    rows_ = int(extent.y() / cell_) + 1;
    nearest_.assign(std::size_t(columns_) * rows_, -1);
    spread_sources();
}

double SizeField::from(int source, const Vec2& point) const
{
    return sources_[source].spacing + SizeFieldTuning::growth * (point - sources_[source].place).norm();
}

// Finds for every cell the source that gives the smallest edge length there: two sweeps over the grid pass sources on
// from cell to cell (Danielsson 1980).
void SizeField::spread_sources()
{
    const auto offer = [&](int column, int row, int source) {
        int& current = nearest_[std::size_t(row) * columns_ + column];
        const Vec2 middle = low_ + cell_ * Vec2(column + 0.5, row + 0.5);
        if (source >= 0 && (current < 0 || from(source, middle) < from(current, middle))) current = source;
    };
    const auto source_of = [&](int column, int row) {
        const bool outside = column < 0 || row < 0 || column >= columns_ || row >= rows_;
        return outside ? -1 : nearest_[std::size_t(row) * columns_ + column];
    };
    for (int source = 0; source < int(sources_.size()); ++source) {
        const Vec2 steps = (sources_[source].place - low_) / cell_;
        offer(std::min(int(steps.x()), columns_ - 1), std::min(int(steps.y()), rows_ - 1), source);
    }
    for (const int direction : {1, -1})
        for (int k = 0; k < rows_; ++k) {
            const int row = direction > 0 ? k : rows_ - 1 - k;
            for (int column = 0; column < columns_; ++column)
                for (const int aside : {-1, 0, 1}) offer(column, row, source_of(column + aside, row - direction));
            for (int column = 0; column < columns_; ++column) offer(column, row, source_of(column - 1, row));
            for (int column = columns_ - 1; column >= 0; --column) offer(column, row, source_of(column + 1, row));
        }
}

double SizeField::at(const Vec2& point) const
{
    if (sources_.empty()) return target_;
    const Vec2 steps = (point - low_) / cell_;
    const int column = std::clamp(int(steps.x()), 0, columns_ - 1), row = std::clamp(int(steps.y()), 0, rows_ - 1);
    double size = target_;
    for (int j = std::max(row - 1, 0); j <= std::min(row + 1, rows_ - 1); ++j)
        for (int i = std::max(column - 1, 0); i <= std::min(column + 1, columns_ - 1); ++i)
            size = std::min(size, from(nearest_[std::size_t(j) * columns_ + i], point));
    return size;
}

}  // namespace selvage
