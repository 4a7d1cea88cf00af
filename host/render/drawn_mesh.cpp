#include "host/render/drawn_mesh.hpp"

#include <cmath>
#include <numeric>
#include <stdexcept>
#include <string>

#include <tbb/parallel_for.h>
#include <Eigen/Geometry>

namespace selvage {
namespace {

constexpr float crease_cosine = 0.5f;   // of 60 degrees; chosen by eye
constexpr double farthest_drawn = 1e6;  // [m]; positions beyond come from a run that diverged

bool can_be_drawn(const Vec3& position)
{
    return position.allFinite() && position.cwiseAbs().maxCoeff() < farthest_drawn;
}

VertexFaces faces_round_vertices(int vertex_count, const std::vector<Face>& faces)
{
    VertexFaces table;
    table.offset.assign(std::size_t(vertex_count) + 1, 0);
    for (const Face& face : faces)
        for (const int vertex : face) ++table.offset[std::size_t(vertex) + 1];
    std::partial_sum(table.offset.begin(), table.offset.end(), table.offset.begin());
    table.face.resize(faces.size() * 3);
    std::vector<int> next(table.offset.begin(), table.offset.end() - 1);
    for (std::size_t face = 0; face < faces.size(); ++face)
        for (const int vertex : faces[face]) table.face[std::size_t(next[std::size_t(vertex)]++)] = int(face);
    return table;
}

Vec3f corner_normal(const DrawnMesh& mesh, const std::vector<float>& areas, int face, int vertex)
{
    const Vec3f& own = mesh.face_normals[std::size_t(face)];
    Vec3f sum = Vec3f::Zero();
    for (const int other : mesh.vertex_faces.of(vertex)) {
        const Vec3f& normal = mesh.face_normals[std::size_t(other)];
        if (normal.dot(own) > crease_cosine) sum += areas[std::size_t(other)] * normal;
    }
    return sum.normalized();
}

}  // namespace

Vec3f DrawnMesh::point(int face, float u, float v) const
{
    const Face& corner = faces[std::size_t(face)];
    return (1 - u - v) * positions[std::size_t(corner[0])] + u * positions[std::size_t(corner[1])] +
           v * positions[std::size_t(corner[2])];
}

DrawnMesh make_drawn_mesh(std::span<const Vec3> positions, std::span<const Face> faces, const Vec3& origin)
{
    DrawnMesh mesh;
    mesh.positions.reserve(positions.size());
    for (const Vec3& position : positions)
        mesh.positions.push_back(can_be_drawn(position) ? Vec3f((position - origin).cast<float>()) : Vec3f::Zero());

    std::vector<float> areas;
    for (std::size_t face = 0; face < faces.size(); ++face) {
        std::array<Vec3, 3> corner;
        bool drawn = true;
        for (std::size_t i = 0; i < 3; ++i) {
            const int vertex = faces[face][i];
            if (vertex < 0 || vertex >= int(positions.size()))
                throw std::invalid_argument("face " + std::to_string(face) + " names vertex " + std::to_string(vertex) +
                                            " of " + std::to_string(positions.size()));
            corner[i] = positions[std::size_t(vertex)];
            drawn = drawn && can_be_drawn(corner[i]);
        }
        if (!drawn) continue;
        const Vec3 cross = (corner[1] - corner[0]).cross(corner[2] - corner[0]);
        const double length = cross.norm();
        if (!(length > 1e-20)) continue;
        mesh.faces.push_back(faces[face]);
        mesh.source_face.push_back(int(face));
        mesh.face_normals.push_back((cross / length).cast<float>());
        areas.push_back(float(length / 2));
    }

    mesh.vertex_faces = faces_round_vertices(int(positions.size()), mesh.faces);
    mesh.normals.resize(mesh.faces.size());
    tbb::parallel_for(0, int(mesh.faces.size()), [&](int face) {
        for (std::size_t i = 0; i < 3; ++i)
            mesh.normals[std::size_t(face)][i] = corner_normal(mesh, areas, face, mesh.faces[std::size_t(face)][i]);
    });
    return mesh;
}

}  // namespace selvage
