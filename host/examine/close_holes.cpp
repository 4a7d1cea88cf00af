#include "host/examine/close_holes.hpp"

#include <algorithm>
#include <array>
#include <limits>

#include "host/mesh/polygon_triangles.hpp"

namespace selvage {
namespace {

constexpr std::size_t most_for_least_area = 160;  // vertices: the search takes their cube

// Cost of a triangle: its area; of equal ones the shorter sides, and no corners on one line if that can be helped.
double cost(const std::vector<Vec3>& vertices, const Face& face)
{
    constexpr double of_sides = 1e-3, flattest = 1e-9, of_line = 1e3;
    double longest = 0;
    for (int k = 0; k < 3; ++k)
        longest = std::max(longest, (vertices[face[k]] - vertices[face[(k + 1) % 3]]).squaredNorm());
    const double area = area_of(vertices, face);
    return area + longest * (area > flattest * longest ? of_sides : of_line);
}

// Least area of triangles over a chain of the rim from corner i to corner k, and the corner between them that gives it.
class LeastArea {
public:
    LeastArea(const std::vector<Vec3>& vertices, const std::vector<int>& rim) : vertices_(vertices), rim_(rim)
    {
        const std::size_t n = rim.size();
        area_.assign(n * n, 0);
        middle_.assign(n * n, 0);
        for (std::size_t span = 2; span < n; ++span)
            for (std::size_t i = 0; i + span < n; ++i) choose(i, i + span);
    }

    void add_triangles(std::size_t i, std::size_t k, std::vector<std::array<int, 3>>& triangles) const
    {
        if (k < i + 2) return;
        const std::size_t j = middle_[i * rim_.size() + k];
        triangles.push_back({int(i), int(j), int(k)});
        add_triangles(i, j, triangles);
        add_triangles(j, k, triangles);
    }

private:
    void choose(std::size_t i, std::size_t k)
    {
        const std::size_t n = rim_.size();
        double least = std::numeric_limits<double>::infinity();
        for (std::size_t j = i + 1; j < k; ++j) {
            const double area = area_[i * n + j] + area_[j * n + k] + cost(vertices_, {rim_[i], rim_[j], rim_[k]});
            if (!(area < least)) continue;
            least = area;
            middle_[i * n + k] = int(j);
        }
        area_[i * n + k] = least;
    }

    const std::vector<Vec3>& vertices_;
    const std::vector<int>& rim_;
    std::vector<double> area_;
    std::vector<int> middle_;
};

}  // namespace

std::vector<Hole> find_holes(const std::vector<Vec3>& vertices, const std::vector<FaceSide>& rim)
{
    std::vector<Hole> holes;
    for (std::vector<int>& loop : rim_loops(rim)) {
        Hole hole{std::move(loop)};
        for (std::size_t k = 0; k < hole.rim.size(); ++k) {
            const Vec3 &a = vertices[hole.rim[k]], &b = vertices[hole.rim[(k + 1) % hole.rim.size()]];
            hole.length += (b - a).norm();
            hole.middle += a / double(hole.rim.size());
        }
        holes.push_back(std::move(hole));
    }
    std::stable_sort(holes.begin(), holes.end(), [](const Hole& a, const Hole& b) { return a.length > b.length; });
    return holes;
}

bool close_hole(const Hole& hole, FileMesh& body)
{
    const std::vector<int>& rim = hole.rim;
    std::vector<std::array<int, 3>> triangles;
    if (rim.size() < 3) return false;
    if (rim.size() <= most_for_least_area) {
        LeastArea(body.mesh.vertices, rim).add_triangles(0, rim.size() - 1, triangles);
    } else if (!split_polygon(body.mesh.vertices, rim, triangles)) {
        return false;
    }
    for (const auto& [a, b, c] : triangles) {
        body.mesh.faces.push_back({rim[a], rim[b], rim[c]});
        body.face_polygons.push_back(-1);
    }
    if (!body.mesh.parts.empty()) body.mesh.parts.back().face_count += int(triangles.size());
    return true;
}

}  // namespace selvage
