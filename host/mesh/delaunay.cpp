#include "host/mesh/delaunay.hpp"

#include <algorithm>
#include <deque>

namespace selvage {
namespace {

using Crossing = std::optional<std::array<int, 2>>;

constexpr int next(int i) { return i == 2 ? 0 : i + 1; }
constexpr int previous(int i) { return i == 0 ? 2 : i - 1; }

int index_of(const Triangulation::Triangle& triangle, int vertex)
{
    return triangle.vertex[0] == vertex ? 0 : triangle.vertex[1] == vertex ? 1 : 2;
}

int opposite_index(const Triangulation::Triangle& triangle, int neighbour)
{
    return triangle.neighbour[0] == neighbour ? 0 : triangle.neighbour[1] == neighbour ? 1 : 2;
}

}  // namespace

Triangulation::Triangulation(std::vector<GridPoint> points) : points_(std::move(points))
{
    const int point_count = int(points_.size());
    const std::vector<int> order = hilbert_order(points_);
    // The corners of the bounding box are the last four points until cut_out removes them.
    constexpr int corner = 1 << 27;
    for (const GridPoint& point : {GridPoint{-corner, -corner}, GridPoint{corner, -corner}, GridPoint{corner, corner},
                                   GridPoint{-corner, corner}})
        points_.push_back(point);
    vertex_triangle_.assign(points_.size(), -1);
    triangles_.reserve(2 * points_.size());
    triangles_.resize(2);
    const int first = point_count;
    set_triangle(0, {{first, first + 1, first + 2}, {-1, 1, -1}, {}});
    set_triangle(1, {{first, first + 2, first + 3}, {-1, -1, 0}, {}});
    int near = 0;
    for (const int vertex : order) {
        near = locate(points_[vertex], near);
        const int inserted = insert_vertex(vertex, near);
        if (inserted >= 0) coincident_ = {std::min(inserted, vertex), std::max(inserted, vertex)};
        near = inserted >= 0 ? vertex_triangle_[inserted] : vertex_triangle_[vertex];
    }
}

void Triangulation::set_triangle(int triangle, const Triangle& value)
{
    triangles_[triangle] = value;
    touched_.push_back(triangle);
    for (int i = 0; i < 3; ++i) {
        vertex_triangle_[value.vertex[i]] = triangle;
        if (value.neighbour[i] < 0) continue;
        Triangle& other = triangles_[value.neighbour[i]];
        for (int j = 0; j < 3; ++j)
            if (other.vertex[next(j)] == value.vertex[previous(i)] &&
                other.vertex[previous(j)] == value.vertex[next(i)])
                other.neighbour[j] = triangle;
    }
}

int Triangulation::new_triangle()
{
    if (!free_triangles_.empty()) {
        const int triangle = free_triangles_.back();
        free_triangles_.pop_back();
        return triangle;
    }
    triangles_.emplace_back();
    return int(triangles_.size()) - 1;
}

// Triangles (a, b, c) and (d, c, b) become (a, b, d) and (a, d, c); a is opposite to the side.
void Triangulation::flip(Side side)
{
    const Triangle t = triangles_[side.triangle];
    const int i = side.index, across = t.neighbour[i];
    const Triangle u = triangles_[across];
    const int j = opposite_index(u, side.triangle);
    const int a = t.vertex[i], b = t.vertex[next(i)], c = t.vertex[previous(i)], d = u.vertex[j];
    set_triangle(side.triangle, {{a, b, d},
                                 {u.neighbour[next(j)], across, t.neighbour[previous(i)]},
                                 {u.fixed[next(j)], false, t.fixed[previous(i)]}});
    set_triangle(across, {{a, d, c},
                          {u.neighbour[previous(j)], t.neighbour[next(i)], side.triangle},
                          {u.fixed[previous(j)], t.fixed[next(i)], false}});
}

bool Triangulation::improvable(Side side) const
{
    const Triangle& t = triangles_[side.triangle];
    const int across = t.vertex[0] < 0 ? -1 : t.neighbour[side.index];
    if (across < 0 || t.fixed[side.index]) return false;
    const Triangle& u = triangles_[across];
    return in_circle(points_[t.vertex[0]], points_[t.vertex[1]], points_[t.vertex[2]],
                     points_[u.vertex[opposite_index(u, side.triangle)]]);
}

void Triangulation::legalise_around_new_vertex()
{
    while (!stack_.empty()) {
        const Side side = stack_.back();
        stack_.pop_back();
        if (!improvable(side)) continue;
        const int across = triangles_[side.triangle].neighbour[side.index];
        flip(side);  // puts the new vertex first in both triangles
        stack_.push_back({side.triangle, 0});
        stack_.push_back({across, 0});
    }
}

void Triangulation::legalise()
{
    while (!stack_.empty()) {
        const Side side = stack_.back();
        stack_.pop_back();
        if (!improvable(side)) continue;
        const int across = triangles_[side.triangle].neighbour[side.index];
        flip(side);
        stack_.push_back({side.triangle, 0});
        stack_.push_back({side.triangle, 2});
        stack_.push_back({across, 0});
        stack_.push_back({across, 1});
    }
}

void Triangulation::restore()
{
    for (int triangle = 0; triangle < int(triangles_.size()); ++triangle)
        for (int i = 0; i < 3; ++i) {
            if (triangles_[triangle].neighbour[i] < triangle) continue;
            stack_.push_back({triangle, i});
            legalise();
            touched_.clear();
        }
}

void Triangulation::restore(const std::vector<int>& triangles)
{
    const std::vector<int> start = triangles;
    touched_.clear();
    for (const int triangle : start)
        for (int i = 0; i < 3; ++i) stack_.push_back({triangle, i});
    legalise();
}

int Triangulation::locate(const GridPoint& point, int start) const
{
    const int step_limit = int(triangles_.size()) + 1;  // a walk in a Delaunay triangulation visits no triangle twice
    int triangle = start, from = -1;
    for (int step = 0; step < step_limit; ++step) {
        const Triangle& t = triangles_[triangle];
        bool inside = true;
        int onward = -1;
        // Each step begins with another side, which keeps the walk from cycling where the triangulation
        // is not Delaunay.
        for (int k = 0, i = step % 3; k < 3 && onward < 0; ++k, i = next(i)) {
            if (t.neighbour[i] == from && from >= 0) continue;
            if (doubled_area(points_[t.vertex[next(i)]], points_[t.vertex[previous(i)]], point) >= 0) continue;
            inside = false;
            onward = t.neighbour[i];
        }
        if (inside) return triangle;
        if (onward < 0) return -1;
        from = triangle;
        triangle = onward;
    }
    return -1;
}

void Triangulation::split_inside(int triangle, int vertex)
{
    const Triangle t = triangles_[triangle];
    const int second = new_triangle(), third = new_triangle();
    const auto [a, b, c] = t.vertex;
    set_triangle(triangle, {{vertex, a, b}, {t.neighbour[2], second, third}, {}});
    set_triangle(second, {{vertex, b, c}, {t.neighbour[0], third, triangle}, {}});
    set_triangle(third, {{vertex, c, a}, {t.neighbour[1], triangle, second}, {}});
    for (const int part : {triangle, second, third}) stack_.push_back({part, 0});
}

void Triangulation::split_side(Side side, int vertex)
{
    const Triangle t = triangles_[side.triangle];
    const int i = side.index, across = t.neighbour[i];
    const Triangle u = triangles_[across];
    const int j = opposite_index(u, side.triangle);
    const int a = t.vertex[i], b = t.vertex[next(i)], c = t.vertex[previous(i)], d = u.vertex[j];
    const int t2 = new_triangle(), u2 = new_triangle();
    set_triangle(side.triangle, {{vertex, a, b}, {t.neighbour[previous(i)], u2, t2}, {}});
    set_triangle(t2, {{vertex, c, a}, {t.neighbour[next(i)], side.triangle, across}, {}});
    set_triangle(across, {{vertex, d, c}, {u.neighbour[previous(j)], t2, u2}, {}});
    set_triangle(u2, {{vertex, b, d}, {u.neighbour[next(j)], across, side.triangle}, {}});
    for (const int part : {side.triangle, t2, across, u2}) stack_.push_back({part, 0});
}

// Returns -1 if the vertex is inserted, the vertex that is already at this point, or -2 if the point is
// on the boundary.
int Triangulation::insert_vertex(int vertex, int triangle)
{
    const Triangle& t = triangles_[triangle];
    const GridPoint& point = points_[vertex];
    touched_.clear();
    for (int i = 0; i < 3; ++i)
        if (points_[t.vertex[i]] == point) return t.vertex[i];
    for (int i = 0; i < 3; ++i) {
        if (doubled_area(points_[t.vertex[next(i)]], points_[t.vertex[previous(i)]], point) != 0) continue;
        if (t.neighbour[i] < 0) return -2;
        split_side({triangle, i}, vertex);
        legalise_around_new_vertex();
        return -1;
    }
    split_inside(triangle, vertex);
    legalise_around_new_vertex();
    return -1;
}

int Triangulation::insert(const GridPoint& point, int triangle)
{
    points_.push_back(point);
    vertex_triangle_.push_back(-1);
    const int vertex = int(points_.size()) - 1;
    if (insert_vertex(vertex, triangle) == -1) return vertex;
    points_.pop_back();
    vertex_triangle_.pop_back();
    return -1;
}

void Triangulation::star(int vertex, std::vector<int>& triangles) const
{
    triangles.clear();
    int first = vertex_triangle_[vertex];
    const int begin = first;
    for (int before = first; before >= 0;) {
        first = before;
        before = triangles_[before].neighbour[previous(index_of(triangles_[before], vertex))];
        if (before == begin) break;
    }
    for (int triangle = first; triangle >= 0;) {
        triangles.push_back(triangle);
        triangle = triangles_[triangle].neighbour[next(index_of(triangles_[triangle], vertex))];
        if (triangle == first) break;
    }
}

// Lowers the degree of a vertex by one: flips one of its edges where both new triangles are valid. Returns false if
// there is no such edge.
bool Triangulation::flip_ear(const std::vector<int>& ring, int vertex)
{
    for (const int triangle : ring) {
        const Triangle& t = triangles_[triangle];
        const int i = index_of(t, vertex), across = t.neighbour[next(i)];
        const Triangle& u = triangles_[across];
        const int ahead = u.vertex[opposite_index(u, triangle)];
        const GridPoint &before = points_[t.vertex[next(i)]], &tip = points_[t.vertex[previous(i)]];
        if (doubled_area(before, tip, points_[ahead]) <= 0) continue;
        if (doubled_area(points_[vertex], before, points_[ahead]) <= 0) continue;
        flip({triangle, next(i)});
        return true;
    }
    return false;
}

bool Triangulation::remove(int vertex)
{
    std::vector<int> ring;
    touched_.clear();
    star(vertex, ring);
    for (const int triangle : ring) {
        const Triangle& t = triangles_[triangle];
        const int i = index_of(t, vertex);
        if (t.neighbour[next(i)] < 0 || t.neighbour[previous(i)] < 0) return false;
    }
    while (ring.size() > 3) {
        if (!flip_ear(ring, vertex)) {
            restore(std::vector<int>(touched_));
            return false;
        }
        star(vertex, ring);
    }
    Triangle merged;
    for (int k = 0; k < 3; ++k) {
        const Triangle& t = triangles_[ring[k]];
        const int i = index_of(t, vertex);
        merged.vertex[k] = t.vertex[next(i)];
        merged.neighbour[previous(k)] = t.neighbour[i];
    }
    for (const int triangle : {ring[1], ring[2]}) {
        triangles_[triangle] = {};
        free_triangles_.push_back(triangle);
    }
    set_triangle(ring[0], merged);
    vertex_triangle_[vertex] = -1;
    std::vector<int> changed = touched_;
    std::erase_if(changed, [&](int triangle) { return triangles_[triangle].vertex[0] < 0; });
    for (const int triangle : changed)
        for (int i = 0; i < 3; ++i) stack_.push_back({triangle, i});
    legalise();
    return true;
}

std::optional<Triangulation::Side> Triangulation::find_side(int from, int to) const
{
    std::vector<int> ring;
    star(from, ring);
    for (const int triangle : ring) {
        const int i = index_of(triangles_[triangle], from);
        if (triangles_[triangle].vertex[next(i)] == to) return Side{triangle, previous(i)};
        if (triangles_[triangle].vertex[previous(i)] == to) return Side{triangle, next(i)};
    }
    return std::nullopt;
}

// Lists the triangle sides that a polygon side, which is not yet in the triangulation, crosses. Returns two polygon
// sides that cross or touch if the side meets a vertex or a fixed side on the way.
Crossing Triangulation::collect_crossed(int side, int polygon_size, std::vector<std::array<int, 2>>& crossed) const
{
    const int from = side, to = (side + 1) % polygon_size;
    const auto left_of = [&](int vertex) { return doubled_area(points_[from], points_[to], points_[vertex]); };
    std::vector<int> ring;
    star(from, ring);
    Side at{-1, 0};
    for (const int triangle : ring) {
        const Triangle& t = triangles_[triangle];
        const int i = index_of(t, from), right = t.vertex[next(i)], left = t.vertex[previous(i)];
        const GridPoint &origin = points_[from], &aim = points_[to], &corner = points_[right];
        const double along =
            double(aim.x - origin.x) * (corner.x - origin.x) + double(aim.y - origin.y) * (corner.y - origin.y);
        if (left_of(right) == 0 && along > 0) return {{side, right}};
        if (left_of(right) < 0 && left_of(left) > 0) at = {triangle, i};
    }
    while (true) {
        const Triangle& t = triangles_[at.triangle];
        const int right = t.vertex[next(at.index)], left = t.vertex[previous(at.index)];
        if (t.fixed[at.index]) return {{side, (right + 1) % polygon_size == left ? right : left}};
        crossed.push_back({right, left});
        const int across = t.neighbour[at.index];
        const Triangle& u = triangles_[across];
        const int tip_index = opposite_index(u, at.triangle), tip = u.vertex[tip_index];
        if (tip == to) return std::nullopt;
        if (left_of(tip) == 0) return {{side, tip}};
        // The polygon side leaves the next triangle opposite its left vertex if the tip lies to the left, else opposite
        // the right one.
        at = {across, left_of(tip) > 0 ? index_of(u, left) : index_of(u, right)};
    }
}

Crossing Triangulation::force_side(int side, int polygon_size)
{
    const int from = side, to = (side + 1) % polygon_size;
    if (!find_side(from, to)) {
        std::vector<std::array<int, 2>> crossed;
        if (const Crossing crossing = collect_crossed(side, polygon_size, crossed)) return crossing;
        const auto left_of = [&](int vertex) { return doubled_area(points_[from], points_[to], points_[vertex]); };
        std::deque<std::array<int, 2>> waiting(crossed.begin(), crossed.end());
        while (!waiting.empty()) {
            const std::array<int, 2> ends = waiting.front();
            waiting.pop_front();
            const Side flipped = *find_side(ends[0], ends[1]);
            const Triangle& t = triangles_[flipped.triangle];
            const Triangle& u = triangles_[t.neighbour[flipped.index]];
            const int a = t.vertex[flipped.index], d = u.vertex[opposite_index(u, flipped.triangle)];
            const GridPoint &b = points_[t.vertex[next(flipped.index)]],
                            &c = points_[t.vertex[previous(flipped.index)]];
            if (doubled_area(points_[a], b, points_[d]) <= 0 || doubled_area(points_[a], points_[d], c) <= 0) {
                waiting.push_back(ends);
                continue;
            }
            flip(flipped);
            const long long left_a = left_of(a), left_d = left_of(d);
            if ((left_a > 0 && left_d < 0) || (left_a < 0 && left_d > 0)) waiting.push_back({a, d});
        }
    }
    const Side made = *find_side(from, to);
    const int across = triangles_[made.triangle].neighbour[made.index];
    triangles_[made.triangle].fixed[made.index] = true;
    triangles_[across].fixed[opposite_index(triangles_[across], made.triangle)] = true;
    return std::nullopt;
}

Crossing Triangulation::cut_out(int polygon_size)
{
    if (coincident_) return coincident_;
    for (int side = 0; side < polygon_size; ++side)
        if (const Crossing crossing = force_side(side, polygon_size))
            return {{std::min((*crossing)[0], (*crossing)[1]), std::max((*crossing)[0], (*crossing)[1])}};
    restore();
    drop_outside();
    return std::nullopt;
}

void Triangulation::drop_outside()
{
    std::vector<char> outside(triangles_.size(), 0);
    std::vector<int> waiting{vertex_triangle_.back()};
    outside[waiting.front()] = 1;
    while (!waiting.empty()) {
        const Triangle& t = triangles_[waiting.back()];
        waiting.pop_back();
        for (int i = 0; i < 3; ++i)
            if (t.neighbour[i] >= 0 && !t.fixed[i] && !outside[t.neighbour[i]]) {
                outside[t.neighbour[i]] = 1;
                waiting.push_back(t.neighbour[i]);
            }
    }
    std::vector<int> renumbered(triangles_.size(), -1);
    int kept = 0;
    for (std::size_t triangle = 0; triangle < triangles_.size(); ++triangle)
        if (!outside[triangle]) renumbered[triangle] = kept++;
    points_.resize(points_.size() - 4);
    vertex_triangle_.assign(points_.size(), -1);
    for (std::size_t triangle = 0; triangle < triangles_.size(); ++triangle) {
        if (outside[triangle]) continue;
        Triangle t = triangles_[triangle];
        for (int& neighbour : t.neighbour) neighbour = neighbour < 0 ? -1 : renumbered[neighbour];
        t.fixed = {};
        for (const int vertex : t.vertex) vertex_triangle_[vertex] = renumbered[triangle];
        triangles_[renumbered[triangle]] = t;
    }
    triangles_.resize(kept);
}

Crossing crossing_sides(const std::vector<Vec2>& polygon)
{
    const GridMap map(polygon);
    std::vector<GridPoint> points;
    for (const Vec2& point : polygon) points.push_back(map.to_grid(point));
    return Triangulation(std::move(points)).cut_out(int(polygon.size()));
}

}  // namespace selvage
