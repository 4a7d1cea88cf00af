#include "host/render/framing.hpp"

#include <algorithm>
#include <numbers>

#include <Eigen/Geometry>

namespace selvage {
namespace {

constexpr float degree = std::numbers::pi_v<float> / 180;

// How much of a body is shown beyond the cloth, over the height of the cloth [1]. Chosen by eye so that the picture of
// a shirt includes the head and the arms.
constexpr float body_above = 0.65f, body_below = 0.30f, body_beside = 0.65f;

void add_drawn_vertices(const DrawnMesh& mesh, std::vector<Vec3f>& points)
{
    for (int vertex = 0; vertex < int(mesh.positions.size()); ++vertex)
        if (!mesh.vertex_faces.of(vertex).empty()) points.push_back(mesh.positions[std::size_t(vertex)]);
}

Eigen::AlignedBox3f box_of(const std::vector<Vec3f>& points)
{
    Eigen::AlignedBox3f box;
    for (const Vec3f& point : points) box.extend(point);
    return box;
}

}  // namespace

std::vector<Vec3f> framed_points(const std::vector<DrawnMesh>& meshes)
{
    std::vector<Vec3f> points, body_points;
    add_drawn_vertices(meshes.front(), points);
    for (std::size_t body = 1; body < meshes.size(); ++body) add_drawn_vertices(meshes[body], body_points);
    if (points.empty()) points.swap(body_points);
    if (points.empty()) points.push_back(Vec3f::Zero());

    Eigen::AlignedBox3f near = box_of(points);
    const float height = near.sizes().z();
    near.min() -= height * Vec3f(body_beside, body_beside, body_below);
    near.max() += height * Vec3f(body_beside, body_beside, body_above);
    std::copy_if(body_points.begin(), body_points.end(), std::back_inserter(points),
                 [&](const Vec3f& point) { return near.contains(point); });
    return points;
}

std::array<ViewDirection, 2> view_directions(PictureViews views, bool has_seams, const std::vector<Vec3f>& points)
{
    if (views == PictureViews::front_and_back || (views == PictureViews::automatic && has_seams))
        return {ViewDirection{0, 5 * degree}, ViewDirection{180 * degree, 5 * degree}};
    if (views == PictureViews::front_and_side) return {ViewDirection{0, 0}, ViewDirection{90 * degree, 0}};

    // The flatter the subject is, the higher the camera stands. Angles chosen by eye.
    const Vec3f size = box_of(points).sizes();
    const float flatness = 1 - std::clamp(size.z() / std::max(size.head<2>().maxCoeff(), 1e-6f), 0.f, 1.f);
    const float elevation = (14 + 20 * flatness) * degree;
    return {ViewDirection{32 * degree, elevation}, ViewDirection{212 * degree, elevation}};
}

}  // namespace selvage
