#include "host/body/tape.hpp"

#include <Eigen/Geometry>

#include "host/mesh/convex_hull.hpp"

namespace selvage {

std::vector<Vec3> section(const Skin& skin, const FaceMask& mask, const Vec3& point, const Vec3& normal)
{
    std::vector<Vec3> points;
    const double level = normal.dot(point);
    for (std::size_t f = 0; f < skin.faces.size(); ++f) {
        if (!mask[f]) continue;
        const Face& face = skin.faces[f];
        std::array<double, 3> above;
        for (int k = 0; k < 3; ++k) above[k] = normal.dot(skin.vertices[face[k]]) - level;
        for (int k = 0; k < 3; ++k) {
            const double one = above[k], two = above[(k + 1) % 3];
            if ((one < 0) == (two < 0)) continue;
            const Vec3& from = skin.vertices[face[k]];
            points.push_back(from + one / (one - two) * (skin.vertices[face[(k + 1) % 3]] - from));
        }
    }
    return points;
}

Vec3 Tape::middle() const
{
    if (points.empty()) return Vec3::Zero();
    double all = 0;
    Vec3 sum = Vec3::Zero();
    for (std::size_t k = 1; k + 1 < points.size(); ++k) {
        const double area = (points[k] - points[0]).cross(points[k + 1] - points[0]).norm();
        sum += area * (points[0] + points[k] + points[k + 1]) / 3;
        all += area;
    }
    return all > 0 ? Vec3(sum / all) : points[0];
}

std::vector<Vec3> Tape::sides() const
{
    std::vector<Vec3> ends;
    for (std::size_t k = 0; k < points.size(); ++k) {
        ends.push_back(points[k]);
        ends.push_back(points[(k + 1) % points.size()]);
    }
    return ends;
}

std::vector<Vec3> crossings(const std::vector<Vec3>& points, const Vec3& point, const Vec3& normal)
{
    std::vector<Vec3> found;
    for (std::size_t k = 0; k + 1 < points.size(); k += 2) {
        const double one = normal.dot(points[k] - point), two = normal.dot(points[k + 1] - point);
        if ((one < 0) != (two < 0)) found.push_back(points[k] + one / (one - two) * (points[k + 1] - points[k]));
    }
    return found;
}

Tape tape_around(const Skin& skin, const FaceMask& mask, const Vec3& point, const Vec3& normal)
{
    Tape tape = tape_over(section(skin, mask, point, normal), point, normal);
    const double level = normal.dot(point);
    for (const OpenEdge& edge : skin.rims) {
        const bool from = normal.dot(skin.vertices[edge.from]) < level, to = normal.dot(skin.vertices[edge.to]) < level;
        tape.over_hole = tape.over_hole || (mask[edge.face] && from != to);
    }
    return tape;
}

Tape tape_over(const std::vector<Vec3>& points, const Vec3& point, const Vec3& normal)
{
    const Vec3 u = normal.unitOrthogonal(), v = normal.cross(u).normalized();
    std::vector<Vec2> flat;
    for (const Vec3& x : points) flat.emplace_back((x - point).dot(u), (x - point).dot(v));
    Tape tape;
    if (flat.size() < 3) return tape;
    const std::vector<Vec2> hull = convex_hull(std::move(flat));
    tape.length = perimeter(hull);
    for (const Vec2& corner : hull) tape.points.push_back(point + corner.x() * u + corner.y() * v);
    return tape;
}

}  // namespace selvage
