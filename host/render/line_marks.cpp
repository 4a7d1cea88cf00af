#include "host/render/line_marks.hpp"

#include <algorithm>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <string>
#include <utility>

namespace selvage {

LineMarks::LineMarks(const DrawnMesh& mesh, std::span<const std::array<int, 2>> lines, float reach)
    : mesh_(&mesh), reach_(reach)
{
    for (const std::array<int, 2>& line : lines) {
        for (const int vertex : line)
            if (vertex < 0 || vertex >= int(mesh.positions.size()))
                throw std::invalid_argument("a line names vertex " + std::to_string(vertex) + " of " +
                                            std::to_string(mesh.positions.size()));
        if (!mesh.vertex_faces.of(line[0]).empty() && !mesh.vertex_faces.of(line[1]).empty()) lines_.push_back(line);
    }

    std::vector<int> last_visit(mesh.faces.size(), -1);
    std::vector<Near> found;
    for (int line = 0; line < int(lines_.size()); ++line) find_faces_near(line, last_visit, found);

    offset_.assign(mesh.faces.size() + 1, 0);
    for (const Near& near : found) ++offset_[std::size_t(near.face) + 1];
    std::partial_sum(offset_.begin(), offset_.end(), offset_.begin());
    near_line_.resize(found.size());
    std::vector<int> next(offset_.begin(), offset_.end() - 1);
    for (const Near& near : found) near_line_[std::size_t(next[std::size_t(near.face)]++)] = near.line;
}

// Walks outwards from the line over faces that share vertices, so that another layer of cloth lying on it
// is not marked.
void LineMarks::find_faces_near(int line, std::vector<int>& last_visit, std::vector<Near>& found) const
{
    std::vector<int> front;
    const auto visit = [&](int vertex) {
        for (const int face : mesh_->vertex_faces.of(vertex))
            if (std::exchange(last_visit[std::size_t(face)], line) != line) front.push_back(face);
    };
    for (const int vertex : lines_[std::size_t(line)]) visit(vertex);
    while (!front.empty()) {
        const int face = front.back();
        front.pop_back();
        const Vec3f centre = mesh_->point(face, 1 / 3.f, 1 / 3.f);
        float radius = 0;
        for (const int vertex : mesh_->faces[std::size_t(face)])
            radius = std::max(radius, (mesh_->positions[std::size_t(vertex)] - centre).norm());
        if (line_distance(line, centre) > reach_ + radius) continue;
        found.push_back({face, line});
        for (const int vertex : mesh_->faces[std::size_t(face)]) visit(vertex);
    }
}

float LineMarks::line_distance(int line, const Vec3f& point) const
{
    const auto [a, b] = lines_[std::size_t(line)];
    const Vec3f& start = mesh_->positions[std::size_t(a)];
    const Vec3f along = mesh_->positions[std::size_t(b)] - start;
    const float length_squared = along.squaredNorm();
    const float t = length_squared > 0 ? std::clamp((point - start).dot(along) / length_squared, 0.f, 1.f) : 0.f;
    return (point - start - t * along).norm();
}

float LineMarks::distance(int face, const Vec3f& point) const
{
    float nearest = std::numeric_limits<float>::infinity();
    if (!mesh_) return nearest;
    for (int i = offset_[std::size_t(face)]; i < offset_[std::size_t(face) + 1]; ++i)
        nearest = std::min(nearest, line_distance(near_line_[std::size_t(i)], point));
    return nearest;
}

std::vector<std::array<int, 2>> boundary_edges(const DrawnMesh& mesh)
{
    std::vector<std::array<int, 2>> edges;
    for (const Face& face : mesh.faces)
        for (std::size_t i = 0; i < 3; ++i) {
            const auto [low, high] = std::minmax(face[i], face[(i + 1) % 3]);
            edges.push_back({low, high});
        }
    std::sort(edges.begin(), edges.end());
    std::vector<std::array<int, 2>> single;
    for (std::size_t i = 0; i < edges.size();) {
        std::size_t end = i + 1;
        while (end < edges.size() && edges[end] == edges[i]) ++end;
        if (end == i + 1) single.push_back(edges[i]);
        i = end;
    }
    return single;
}

}  // namespace selvage
