#pragma once
#include <array>
#include <span>
#include <vector>

#include "host/render/drawn_mesh.hpp"

namespace selvage {

/// Lines drawn on a mesh between pairs of its vertices, with a list of the lines near each face.
class LineMarks {
public:
    LineMarks() = default;

    /// @param mesh   outlives this object
    /// @param lines  vertex pairs; those with a vertex that touches no drawn face are ignored
    /// @param reach  largest distance from a line that distance() must know [m]
    /// @throws std::invalid_argument if a line names a vertex that does not exist.
    LineMarks(const DrawnMesh& mesh, std::span<const std::array<int, 2>> lines, float reach);

    /// Returns the distance [m] from a point on a face to the nearest line to which the surface around it leads;
    /// infinity beyond the reach.
    float distance(int face, const Vec3f& point) const;

private:
    struct Near {
        int face, line;
    };
    void find_faces_near(int line, std::vector<int>& last_visit, std::vector<Near>& found) const;
    float line_distance(int line, const Vec3f& point) const;

    const DrawnMesh* mesh_ = nullptr;
    std::vector<std::array<int, 2>> lines_;
    float reach_ = 0;
    std::vector<int> offset_;     ///< Face count + 1.
    std::vector<int> near_line_;  ///< Lines near each face.
};

/// Returns the edges that belong to one drawn face only: the hems.
std::vector<std::array<int, 2>> boundary_edges(const DrawnMesh& mesh);

}  // namespace selvage
