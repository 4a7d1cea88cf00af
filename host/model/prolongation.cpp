#include "host/model/prolongation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <stdexcept>
#include <utility>

namespace selvage {
namespace {

// Weights below this are dropped [1]. Rounding leaves weights of 1e-17 where a vertex lies on an edge. Products of such
// weights add entries to the coarse matrices, and in single precision these are subnormal numbers, with which
// processors are slow. Any value between the rounding and a real weight serves.
constexpr double least_weight = 1e-7;

struct Row {
    std::array<int, 3> column{-1, -1, -1};  // -1: unused
    std::array<double, 3> weight{0, 0, 0};
};

// Returns the weights of the point of the segment ab that is nearest to p.
std::array<double, 2> nearest_on_segment(const Vec2& p, const Vec2& a, const Vec2& b)
{
    const double length_squared = (b - a).squaredNorm();
    const double t = length_squared > 0 ? std::clamp((p - a).dot(b - a) / length_squared, 0.0, 1.0) : 0.0;
    return {1 - t, t};
}

// Returns the weights of the point of the triangle that is nearest to p.
std::array<double, 3> nearest_on_triangle(const Vec2& p, const std::array<Vec2, 3>& corner)
{
    const auto doubled = [](const Vec2& a, const Vec2& b, const Vec2& c) {
        return (b - a).x() * (c - a).y() - (b - a).y() * (c - a).x();
    };
    const double whole = doubled(corner[0], corner[1], corner[2]);
    const double first = doubled(p, corner[1], corner[2]), second = doubled(p, corner[2], corner[0]);
    const double third = doubled(p, corner[0], corner[1]);
    if (whole > 0 && first >= 0 && second >= 0 && third >= 0) {
        const double sum = first + second + third;
        return {first / sum, second / sum, third / sum};
    }
    std::array<double, 3> best{1, 0, 0};
    double best_squared = std::numeric_limits<double>::infinity();
    for (int i = 0; i < 3; ++i) {
        const int j = (i + 1) % 3;
        const auto [at_i, at_j] = nearest_on_segment(p, corner[i], corner[j]);
        const double squared = (at_i * corner[i] + at_j * corner[j] - p).squaredNorm();
        if (squared >= best_squared) continue;
        best_squared = squared;
        best = {0, 0, 0};
        best[i] = at_i;
        best[j] = at_j;
    }
    return best;
}

// The triangles of one panel, sorted into the square cells of a grid.
class TriangleGrid {
public:
    TriangleGrid(const Cloth& cloth, const ClothPanel& panel) : cloth_(cloth), panel_(panel)
    {
        low_ = cloth.panel_coordinates[panel.first_vertex];
        Vec2 high = low_;
        for (int vertex = panel.first_vertex; vertex < panel.first_vertex + panel.vertex_count; ++vertex) {
            low_ = low_.cwiseMin(cloth.panel_coordinates[vertex]);
            high = high.cwiseMax(cloth.panel_coordinates[vertex]);
        }
        const Vec2 extent = high - low_;
        // About two triangles per cell. The second bound limits the number of cells where the bounding box
        // is very narrow.
        cell_ = std::max(std::sqrt(2 * extent.x() * extent.y() / panel.face_count),
                         1e-3 * extent.maxCoeff() / std::sqrt(panel.face_count));
        columns_ = int(extent.x() / cell_) + 1;
        rows_ = int(extent.y() / cell_) + 1;
        first_.assign(std::size_t(columns_) * rows_ + 1, 0);
        for_each_cell([&](std::size_t cell, int) { ++first_[cell + 1]; });
        for (std::size_t cell = 1; cell < first_.size(); ++cell) first_[cell] += first_[cell - 1];
        faces_.resize(first_.back());
        std::vector<int> fill(first_.begin(), first_.end() - 1);
        for_each_cell([&](std::size_t cell, int face) { faces_[fill[cell]++] = face; });
    }

    // Searches rings of cells around the point, from the inside out, until no further ring can hold a nearer triangle.
    Row find(const Vec2& point) const
    {
        const int column = column_of(point.x()), row = row_of(point.y());
        const double outside = std::max({low_.x() - point.x(), point.x() - low_.x() - columns_ * cell_,
                                         low_.y() - point.y(), point.y() - low_.y() - rows_ * cell_, 0.0});
        Row best;
        double best_squared = std::numeric_limits<double>::infinity();
        for (int ring = 0; ring <= std::max(columns_, rows_); ++ring) {
            const double reached = std::max(outside, (ring - 1) * cell_);
            if (ring > 0 && best_squared <= reached * reached) break;
            for (int j = std::max(row - ring, 0); j <= std::min(row + ring, rows_ - 1); ++j) {
                const bool whole = std::abs(j - row) == ring;
                for (int i = column - ring; i <= column + ring; i += whole || ring == 0 ? 1 : 2 * ring)
                    if (i >= 0 && i < columns_) search_cell(std::size_t(j) * columns_ + i, point, best, best_squared);
            }
        }
        return best;
    }

private:
    int column_of(double x) const { return std::clamp(int(std::floor((x - low_.x()) / cell_)), 0, columns_ - 1); }
    int row_of(double y) const { return std::clamp(int(std::floor((y - low_.y()) / cell_)), 0, rows_ - 1); }

    std::array<Vec2, 3> corners(int face) const
    {
        const Face& vertices = cloth_.faces[face];
        return {cloth_.panel_coordinates[vertices[0]], cloth_.panel_coordinates[vertices[1]],
                cloth_.panel_coordinates[vertices[2]]};
    }

    template <class Visit>
    void for_each_cell(const Visit& visit) const
    {
        for (int face = panel_.first_face; face < panel_.first_face + panel_.face_count; ++face) {
            const std::array<Vec2, 3> corner = corners(face);
            const Vec2 low = corner[0].cwiseMin(corner[1]).cwiseMin(corner[2]);
            const Vec2 high = corner[0].cwiseMax(corner[1]).cwiseMax(corner[2]);
            for (int j = row_of(low.y()); j <= row_of(high.y()); ++j)
                for (int i = column_of(low.x()); i <= column_of(high.x()); ++i)
                    visit(std::size_t(j) * columns_ + i, face);
        }
    }

    void search_cell(std::size_t cell, const Vec2& point, Row& best, double& best_squared) const
    {
        for (int k = first_[cell]; k < first_[cell + 1] && best_squared > 0; ++k) {
            const std::array<Vec2, 3> corner = corners(faces_[k]);
            const std::array<double, 3> weight = nearest_on_triangle(point, corner);
            const bool inside = weight[0] > 0 && weight[1] > 0 && weight[2] > 0;
            const double squared =
                inside ? 0.0
                       : (weight[0] * corner[0] + weight[1] * corner[1] + weight[2] * corner[2] - point).squaredNorm();
            if (squared >= best_squared) continue;
            best_squared = squared;
            best = {cloth_.faces[faces_[k]], weight};
        }
    }

    const Cloth& cloth_;
    const ClothPanel& panel_;
    Vec2 low_;
    double cell_ = 1;
    int columns_ = 1, rows_ = 1;
    std::vector<int> first_;  // start of each cell's faces in faces_
    std::vector<int> faces_;
};

// Returns the row of a vertex at an arc-length fraction of an outline edge of the coarse cloth.
Row row_on_edge(const OutlineSamples& coarse, double parameter)
{
    const auto above = std::upper_bound(coarse.parameters.begin() + 1, coarse.parameters.end() - 1, parameter);
    const std::size_t k = above - coarse.parameters.begin();
    const double from = coarse.parameters[k - 1], to = coarse.parameters[k];
    const double fraction = std::clamp((parameter - from) / (to - from), 0.0, 1.0);
    return {{coarse.vertices[k - 1], coarse.vertices[k], -1}, {1 - fraction, fraction, 0}};
}

void fill_outline_rows(const Cloth& coarse, const Cloth& fine, std::vector<Row>& rows)
{
    std::map<std::pair<int, int>, const OutlineSamples*> edges;
    for (const OutlineSamples& samples : coarse.outline) edges[{samples.panel, samples.edge}] = &samples;
    for (const OutlineSamples& samples : fine.outline) {
        const auto edge = edges.find({samples.panel, samples.edge});
        if (edge == edges.end())
            throw std::invalid_argument("make_prolongation: the two cloths have different outlines");
        for (std::size_t i = 0; i < samples.vertices.size(); ++i)
            rows[samples.vertices[i]] = row_on_edge(*edge->second, samples.parameters[i]);
    }
}

}  // namespace

Prolongation make_prolongation(const Cloth& coarse, const Cloth& fine)
{
    const bool alike = std::equal(coarse.panels.begin(), coarse.panels.end(), fine.panels.begin(), fine.panels.end(),
                                  [](const ClothPanel& a, const ClothPanel& b) { return a.name == b.name; });
    if (!alike) throw std::invalid_argument("make_prolongation: the two cloths have different panels");
    std::vector<Row> rows(fine.positions.size());
    fill_outline_rows(coarse, fine, rows);
    for (std::size_t panel = 0; panel < fine.panels.size(); ++panel) {
        const TriangleGrid grid(coarse, coarse.panels[panel]);
        const int first = fine.panels[panel].first_vertex;
        for (int vertex = first; vertex < first + fine.panels[panel].vertex_count; ++vertex)
            if (rows[vertex].column[0] < 0) rows[vertex] = grid.find(fine.panel_coordinates[vertex]);
    }
    Prolongation prolongation;
    prolongation.offset.push_back(0);
    for (const Row& row : rows) {
        double sum = 0;
        for (const double weight : row.weight) sum += weight > least_weight ? weight : 0;
        for (int i = 0; i < 3; ++i) {
            if (!(row.weight[i] > least_weight)) continue;
            prolongation.column.push_back(row.column[i]);
            prolongation.weight.push_back(row.weight[i] / sum);
        }
        prolongation.offset.push_back(int(prolongation.column.size()));
    }
    return prolongation;
}

}  // namespace selvage
