#pragma once
#include <array>
#include <tuple>
#include <vector>

#include "host/mesh/closest_on_triangle.hpp"
#include "io/geometry.hpp"

namespace selvage {

/// The contact of a point with the surface nearest to it.
struct SurfaceContact {
    double signed_distance = 0;   ///< To the triangulated surface [m], negative inside.
    double gap = 0;               ///< (x - closest point) . normal [m].
    Vec3 normal = Vec3::UnitZ();  ///< Unit contact normal, out of the body.
};

/// The normals of a body's mesh: for the sign of a distance and for smooth contact.
///
/// Sign: angle-weighted pseudo-normals of faces, edges and vertices (Baerentzen and Aanaes 2005).
///
/// Contact normal: interpolated corner normals (Phong), so that it turns continuously across the facets of a rounded
/// body. Corner normals are angle-weighted means over the faces that meet at a vertex without a sharp edge between
/// them; an edge is sharp if it is convex and bends by more than 50 degrees. Outside a sharp edge, where the edge
/// itself is closest, the normal turns from the one face's to the other's as the direction to x does, so it is
/// continuous there too; inside, it jumps where the closest face changes, and only the gap is continuous.
/// Concave creases are always smoothed: both sides then agree on one normal near the crease.
/// Where the interpolated normal and the direction to the closest point are more than 60 degrees apart (needle tips,
/// deep slots), the contact normal is blended towards the latter.
class BodySurface {
public:
    /// Vertices at exactly the same position are treated as one; faces without area are ignored.
    explicit BodySurface(const TriangleMesh& mesh);

    /// What the surface of a mesh takes [bytes]. @param deforms  it will be deformed
    static std::size_t bytes_of(const TriangleMesh& mesh, bool deforms)
    {
        const std::size_t per_face = sizeof(Face) + sizeof(Vec3) + 2 * sizeof(Corners) + 2 * sizeof(std::array<int, 3>);
        const std::size_t sides = deforms ? 3 * sizeof(Sides::value_type) : 0;
        return mesh.faces.size() * (per_face + sides) + mesh.vertices.size() * (2 * sizeof(Vec3) + 1);
    }

    /// Moves the vertices. The set of sharp edges does not change. Faces that had no area must not get one.
    /// @param vertices  as many as the mesh had [m]
    void deform(const std::vector<Vec3>& vertices);

    int triangle_count() const { return int(faces_.size()); }
    bool has_area(int triangle) const { return face_normals_[triangle].squaredNorm() > 0.5; }
    const Vec3& corner(int triangle, int local) const { return vertices_[faces_[triangle][local]]; }
    const std::vector<Vec3>& vertices() const { return vertices_; }
    const Face& face(int triangle) const { return faces_[triangle]; }
    const Vec3& face_normal(int triangle) const { return face_normals_[triangle]; }

    ClosestOnTriangle closest(const Vec3& x, int triangle) const
    {
        return closest_on_triangle(x, corner(triangle, 0), corner(triangle, 1), corner(triangle, 2));
    }

    /// Describes the contact of x with the surface, given the triangle closest to x.
    SurfaceContact contact(const Vec3& x, int triangle) const;

private:
    using Corners = std::array<Vec3, 3>;

    using Sides = std::vector<std::tuple<int, int, int>>;  ///< Lower and higher vertex of an edge, 3 * face + edge.

    void find_face_normals();
    Sides sorted_sides() const;
    void find_neighbours(const Sides& sides);
    void find_edge_normals(const Sides& sides);
    void find_groups();
    void find_corner_normals();
    bool is_sharp(int triangle, int local) const;
    const Vec3& pseudo_normal(int triangle, const ClosestOnTriangle& closest) const;
    Vec3 smooth_normal(int triangle, const ClosestOnTriangle& closest, const Vec3& direction) const;
    Vec3 edge_normal(int triangle, const ClosestOnTriangle& closest, const Vec3& direction) const;

    std::vector<Vec3> vertices_;
    std::vector<Face> faces_;
    std::vector<Vec3> face_normals_;                ///< Unit, or zero for a face without area.
    std::vector<Vec3> vertex_normals_;              ///< Angle-weighted sums over all faces of a vertex.
    std::vector<Corners> edge_normals_;             ///< Per face and edge: sum over the faces of the edge.
    std::vector<Corners> corner_normals_;           ///< Per face and corner: unit, smooth up to sharp edges.
    std::vector<std::array<int, 3>> corner_group_;  ///< Equal for the corners that share one normal.
    std::vector<char> has_several_groups_;          ///< Per vertex: it lies on sharp edges that divide its faces.
    Sides sides_;                                   ///< Kept once the surface has deformed; else empty.
    std::vector<std::array<int, 3>> neighbour_;     ///< Per face and edge: 3 * face + edge beyond it, or -1.
};

}  // namespace selvage
