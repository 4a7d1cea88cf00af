#pragma once
#include <array>
#include <optional>
#include <vector>

#include "host/mesh/grid_point.hpp"

namespace selvage {

/// A Delaunay triangulation on the integer grid. It can be cut to a polygon, and vertices can be inserted, moved and
/// removed. Points are inserted one by one with edge flips (Lawson 1977), and polygon sides are recovered by edge
/// flips (Sloan 1993).
class Triangulation {
public:
    struct Triangle {
        std::array<int, 3> vertex{-1, -1, -1};           ///< Counter-clockwise; vertex[0] < 0 marks a free slot.
        std::array<int, 3> neighbour{-1, -1, -1};        ///< Across the side opposite to vertex i; -1 outside.
        std::array<bool, 3> fixed{false, false, false};  ///< The side opposite to vertex i must not be flipped.
    };

    /// Triangulates a box around the points together with the points. Call cut_out before anything else.
    /// @param points  of coincident points only one is used, see coincident()
    explicit Triangulation(std::vector<GridPoint> points);

    /// Returns the indices of two points that coincide, if there are any.
    const std::optional<std::array<int, 2>>& coincident() const { return coincident_; }

    /// Makes the polygon through points 0, 1, ..., polygon_size - 1 the boundary and drops what lies outside.
    /// @returns two polygon sides (side k starts at point k) that cross or touch, in which case the
    ///          triangulation is unusable; nothing if the polygon is simple
    std::optional<std::array<int, 2>> cut_out(int polygon_size);

    /// Returns the triangle that contains the point, walking from triangle `start`; -1 if the walk meets the boundary.
    int locate(const GridPoint& point, int start) const;

    /// Inserts a point into the triangle that contains it and restores the Delaunay property.
    /// @returns the new vertex, or -1 if the point coincides with a vertex or lies on the boundary
    int insert(const GridPoint& point, int triangle);

    /// Removes a vertex. Returns false if it is on the boundary or if rounding to the grid leaves no valid flip.
    bool remove(int vertex);

    /// Moves a vertex. No triangle may become inverted; call restore() afterwards.
    void move(int vertex, const GridPoint& point) { points_[vertex] = point; }

    /// Flips sides until every triangle is Delaunay within the boundary.
    void restore();
    /// Does the same from the sides of the given triangles outwards; touched() then lists the changed triangles.
    void restore(const std::vector<int>& triangles);

    /// Collects the triangles around a vertex, counter-clockwise.
    void star(int vertex, std::vector<int>& triangles) const;

    const std::vector<GridPoint>& points() const { return points_; }
    const std::vector<Triangle>& triangles() const { return triangles_; }
    bool alive(int vertex) const { return vertex_triangle_[vertex] >= 0; }
    /// Triangles written by the last insert, remove or restore; may hold repetitions and free slots.
    const std::vector<int>& touched() const { return touched_; }

private:
    struct Side {
        int triangle, index;
    };

    void set_triangle(int triangle, const Triangle& value);
    int new_triangle();
    void flip(Side side);
    bool improvable(Side side) const;
    void legalise_around_new_vertex();
    void legalise();
    void split_inside(int triangle, int vertex);
    void split_side(Side side, int vertex);
    int insert_vertex(int vertex, int triangle);
    std::optional<Side> find_side(int from, int to) const;
    bool flip_ear(const std::vector<int>& ring, int vertex);
    std::optional<std::array<int, 2>> force_side(int side, int polygon_size);
    std::optional<std::array<int, 2>> collect_crossed(int side, int polygon_size,
                                                      std::vector<std::array<int, 2>>& crossed) const;
    void drop_outside();

    std::vector<GridPoint> points_;
    std::vector<Triangle> triangles_;
    std::vector<int> vertex_triangle_;  // one triangle at each vertex; -1 for a removed vertex
    std::vector<int> free_triangles_;
    std::vector<Side> stack_;
    std::vector<int> touched_;
    std::optional<std::array<int, 2>> coincident_;
};

/// Returns two sides of the closed polygon that cross or touch (side k starts at point k), if there are any.
std::optional<std::array<int, 2>> crossing_sides(const std::vector<Vec2>& polygon);

}  // namespace selvage
