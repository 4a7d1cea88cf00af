#include "host/mesh/surface_net.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <Eigen/Geometry>

namespace selvage {
namespace {

using Quad = std::array<int, 4>;

constexpr int block_size = 8;  // samples of a block along an axis; far blocks are skipped; chosen by hand, not measured

/// Field samples on a regular grid; x runs fastest.
struct Grid {
    Vec3 origin;
    double spacing = 0;
    std::array<int, 3> count{};
    std::vector<float> value;

    int index(int i, int j, int k) const { return (k * count[1] + j) * count[0] + i; }
    Vec3 point(int i, int j, int k) const { return origin + spacing * Vec3(i, j, k); }
};

/// Offset in samples from a cell's lowest corner to its corner c (bits of c: x, y, z).
int corner_offset(const Grid& grid, int corner) { return grid.index(corner & 1, (corner >> 1) & 1, (corner >> 2) & 1); }

void fill_block(Grid& grid, const ScalarField& field, const std::array<int, 3>& first, double steepness)
{
    std::array<int, 3> last;
    for (int axis = 0; axis < 3; ++axis) last[axis] = std::min(first[axis] + block_size, grid.count[axis]);
    const double half = 0.5 * (block_size - 1);
    const double centre = field(grid.point(first[0], first[1], first[2]) + grid.spacing * Vec3::Constant(half));
    const bool far = std::abs(centre) > steepness * std::sqrt(3.0) * half * grid.spacing;
    for (int k = first[2]; k < last[2]; ++k)
        for (int j = first[1]; j < last[1]; ++j)
            for (int i = first[0]; i < last[0]; ++i)
                grid.value[grid.index(i, j, k)] = float(far ? centre : field(grid.point(i, j, k)));
}

Grid sample(const ScalarField& field, const Vec3& low, const Vec3& high, const SurfaceNetOptions& options)
{
    Grid grid;
    grid.spacing = options.spacing;
    std::array<int, 3> blocks;
    for (int axis = 0; axis < 3; ++axis) {
        grid.count[axis] = int(std::ceil((high[axis] - low[axis]) / options.spacing)) + 3;
        blocks[axis] = (grid.count[axis] + block_size - 1) / block_size;
        grid.origin[axis] = 0.5 * (low[axis] + high[axis] - (grid.count[axis] - 1) * options.spacing);
    }
    grid.value.resize(std::size_t(grid.count[0]) * grid.count[1] * grid.count[2]);
    tbb::parallel_for(0, blocks[0] * blocks[1] * blocks[2], [&](int block) {
        const int i = block % blocks[0], j = block / blocks[0] % blocks[1], k = block / (blocks[0] * blocks[1]);
        fill_block(grid, field, {block_size * i, block_size * j, block_size * k}, options.steepness);
    });
    return grid;
}

int inside_mask(const Grid& grid, int cell, const std::array<int, 8>& offset)
{
    int mask = 0;
    for (int corner = 0; corner < 8; ++corner) mask |= int(grid.value[cell + offset[corner]] < 0) << corner;
    return mask;
}

/// Bits of the outside corners that make a cell ambiguous: those of a face whose inside corners are
/// diagonal, or all of them when exactly two opposite corners of the cell differ from the rest.
int ambiguous_corners(int mask)
{
    static constexpr std::array<std::array<int, 4>, 6> faces{
        {{0, 2, 6, 4}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 3, 7, 6}, {0, 1, 3, 2}, {4, 5, 7, 6}}};
    int flip = 0;
    for (const auto& face : faces) {
        const int even = (1 << face[0]) | (1 << face[2]), odd = (1 << face[1]) | (1 << face[3]);
        if ((mask & even) == even && (mask & odd) == 0) flip |= odd;
        if ((mask & odd) == odd && (mask & even) == 0) flip |= even;
    }
    for (int corner = 0; corner < 4; ++corner) {
        const int diagonal = (1 << corner) | (1 << (7 - corner));
        if (mask == diagonal || mask == (0xff ^ diagonal)) flip |= 0xff ^ mask;
    }
    return flip;
}

template <class Visit>
void for_each_cell(const Grid& grid, Visit visit)
{
    for (int k = 0; k + 1 < grid.count[2]; ++k)
        for (int j = 0; j + 1 < grid.count[1]; ++j)
            for (int i = 0; i + 1 < grid.count[0]; ++i) visit(i, j, k);
}

/// Makes outside samples of ambiguous cells inside ones until no cell is ambiguous. The loop ends, since the
/// shape only grows.
void make_well_composed(Grid& grid, const std::array<int, 8>& offset)
{
    const auto value_just_inside = float(-1e-6);
    for (bool changed = true; changed;) {
        changed = false;
        for_each_cell(grid, [&](int i, int j, int k) {
            const int cell = grid.index(i, j, k);
            const int mask = inside_mask(grid, cell, offset);
            if (mask == 0 || mask == 0xff) return;
            const int flip = ambiguous_corners(mask);
            for (int corner = 0; corner < 8; ++corner)
                if (flip >> corner & 1) grid.value[cell + offset[corner]] = value_just_inside;
            changed = changed || flip != 0;
        });
    }
}

/// Mean of the points where the surface crosses the cell's edges.
Vec3 cell_vertex(const Grid& grid, int i, int j, int k, int mask, const std::array<int, 8>& offset)
{
    Vec3 sum = Vec3::Zero();
    int crossings = 0;
    const int cell = grid.index(i, j, k);
    for (int corner = 0; corner < 8; ++corner)
        for (int axis = 0; axis < 3; ++axis) {
            const int other = corner | (1 << axis);
            if (other == corner || ((mask >> corner ^ mask >> other) & 1) == 0) continue;
            const double a = grid.value[cell + offset[corner]], b = grid.value[cell + offset[other]];
            Vec3 crossing(corner & 1, (corner >> 1) & 1, (corner >> 2) & 1);
            crossing[axis] += a / (a - b);
            sum += crossing;
            ++crossings;
        }
    return grid.point(i, j, k) + grid.spacing * sum / crossings;
}

/// Returns one quad per crossed grid edge, counter-clockwise as seen from outside.
std::vector<Quad> net_quads(const Grid& grid, const std::vector<int>& vertex_of_cell)
{
    std::vector<Quad> quads;
    for_each_cell(grid, [&](int i, int j, int k) {
        const std::array<int, 3> at{i, j, k};
        const bool inside = grid.value[grid.index(i, j, k)] < 0;
        for (int axis = 0; axis < 3; ++axis) {
            std::array<int, 3> step{0, 0, 0};
            step[axis] = 1;
            const bool other = grid.value[grid.index(i + step[0], j + step[1], k + step[2])] < 0;
            const int u = (axis + 1) % 3, v = (axis + 2) % 3;
            if (inside == other || at[u] == 0 || at[v] == 0) continue;
            auto cell = [&](int du, int dv) {
                std::array<int, 3> c = at;
                c[u] -= du;
                c[v] -= dv;
                return vertex_of_cell[grid.index(c[0], c[1], c[2])];
            };
            Quad quad{cell(1, 1), cell(0, 1), cell(0, 0), cell(1, 0)};
            if (!inside) std::swap(quad[1], quad[3]);
            quads.push_back(quad);
        }
    });
    return quads;
}

/// Neighbours along quad edges in compressed rows. The net is closed, so each edge is listed once at either end.
struct Neighbours {
    std::vector<int> offset, vertex;
};

Neighbours find_neighbours(const std::vector<Quad>& quads, int vertex_count)
{
    Neighbours rows;
    rows.offset.assign(vertex_count + 1, 0);
    for (const Quad& quad : quads)
        for (int vertex : quad) ++rows.offset[vertex + 1];
    for (int vertex = 0; vertex < vertex_count; ++vertex) rows.offset[vertex + 1] += rows.offset[vertex];
    rows.vertex.resize(rows.offset.back());
    std::vector<int> next(rows.offset.begin(), rows.offset.end() - 1);
    for (const Quad& quad : quads)
        for (int corner = 0; corner < 4; ++corner) rows.vertex[next[quad[corner]]++] = quad[(corner + 1) % 4];
    return rows;
}

/// Moves a point towards the surface by one Newton step along the gradient, at most half a cell long. Four samples give
/// the value and the gradient.
Vec3 project(const ScalarField& field, const Vec3& point, double spacing)
{
    static const std::array<Vec3, 4> taps{Vec3(1, -1, -1), Vec3(-1, -1, 1), Vec3(-1, 1, -1), Vec3(1, 1, 1)};
    const double reach = 0.02 * spacing;
    double value = 0;
    Vec3 gradient = Vec3::Zero();
    for (const Vec3& tap : taps) {
        const double sampled = field(point + reach * tap);
        value += 0.25 * sampled;
        gradient += sampled / (4 * reach) * tap;
    }
    Vec3 step = -value / std::max(gradient.squaredNorm(), 0.05) * gradient;
    const double limit = 0.5 * spacing;
    if (step.norm() > limit) step *= limit / step.norm();
    return point + step;
}

void relax(std::vector<Vec3>& vertices, const Neighbours& rows, const ScalarField& field,
           const SurfaceNetOptions& options)
{
    std::vector<Vec3> moved(vertices.size());
    const int final_projections = 2;
    for (int round = 0; round < options.smoothing_rounds + final_projections; ++round) {
        const double weight = round < options.smoothing_rounds ? 0.6 : 0.0;
        tbb::parallel_for(tbb::blocked_range<int>(0, int(vertices.size()), 256), [&](const auto& range) {
            for (int vertex = range.begin(); vertex < range.end(); ++vertex) {
                Vec3 mean = Vec3::Zero();
                for (int at = rows.offset[vertex]; at < rows.offset[vertex + 1]; ++at)
                    mean += vertices[rows.vertex[at]];
                mean /= rows.offset[vertex + 1] - rows.offset[vertex];
                moved[vertex] = project(field, (1 - weight) * vertices[vertex] + weight * mean, options.spacing);
            }
        });
        vertices.swap(moved);
    }
}

/// Returns the cosine of a triangle's smallest angle.
double smallest_angle_cosine(const Vec3& a, const Vec3& b, const Vec3& c)
{
    const Vec3 ab = (b - a).normalized(), bc = (c - b).normalized(), ca = (a - c).normalized();
    return std::max({-ab.dot(ca), -bc.dot(ab), -ca.dot(bc)});
}

/// Divides every quad along the diagonal that makes the smallest angle of its two triangles larger.
std::vector<Face> split_quads(const std::vector<Quad>& quads, const std::vector<Vec3>& x)
{
    std::vector<Face> faces;
    faces.reserve(2 * quads.size());
    for (const auto& [a, b, c, d] : quads) {
        const double along_ac =
            std::max(smallest_angle_cosine(x[a], x[b], x[c]), smallest_angle_cosine(x[a], x[c], x[d]));
        const double along_bd =
            std::max(smallest_angle_cosine(x[a], x[b], x[d]), smallest_angle_cosine(x[b], x[c], x[d]));
        if (along_ac <= along_bd) {
            faces.push_back({a, b, c});
            faces.push_back({a, c, d});
        } else {
            faces.push_back({a, b, d});
            faces.push_back({b, c, d});
        }
    }
    return faces;
}

}  // namespace

TriangleMesh surface_net(const ScalarField& field, const Vec3& low, const Vec3& high, const SurfaceNetOptions& options)
{
    Grid grid = sample(field, low, high, options);
    std::array<int, 8> offset;
    for (int corner = 0; corner < 8; ++corner) offset[corner] = corner_offset(grid, corner);
    make_well_composed(grid, offset);

    TriangleMesh mesh;
    std::vector<int> vertex_of_cell(grid.value.size(), -1);
    for_each_cell(grid, [&](int i, int j, int k) {
        const int cell = grid.index(i, j, k);
        const int mask = inside_mask(grid, cell, offset);
        if (mask == 0 || mask == 0xff) return;
        vertex_of_cell[cell] = int(mesh.vertices.size());
        mesh.vertices.push_back(cell_vertex(grid, i, j, k, mask, offset));
    });
    const std::vector<Quad> quads = net_quads(grid, vertex_of_cell);
    relax(mesh.vertices, find_neighbours(quads, int(mesh.vertices.size())), field, options);
    mesh.faces = split_quads(quads, mesh.vertices);
    return mesh;
}

}  // namespace selvage
