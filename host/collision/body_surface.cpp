#include "host/collision/body_surface.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

#include <Eigen/Geometry>

#include "host/mesh/body_tessellation.hpp"

namespace selvage {
namespace {

// Chosen by hand, not measured. The unit tests of continuous contacts around facets, creases, rims and needle tips
// check what they achieve together.
struct ContactNormalTuning {
    static constexpr double sharp_cosine = 0.642787609686539;  // of the bend of a sharp edge: 50 degrees
    // Cosine of the angle between the smooth normal and the direction to the closest point, above which the smooth
    // normal is used and below which only the direction is used.
    static constexpr double smooth_cosine = 0.5;
    static constexpr double direction_cosine = 0.25;
};

constexpr double least_distance = 1e-12;  // [m]; below it, rounding determines the direction to the closest point

double corner_angle(const Vec3& apex, const Vec3& a, const Vec3& b)
{
    const Vec3 u = a - apex, v = b - apex;
    return std::atan2(u.cross(v).norm(), u.dot(v));
}

Vec3 unit_or(const Vec3& v, const Vec3& otherwise)
{
    const double norm = v.norm();
    return norm > 1e-9 ? Vec3(v / norm) : otherwise;
}

bool same_edge(const std::tuple<int, int, int>& a, const std::tuple<int, int, int>& b)
{
    return std::get<0>(a) == std::get<0>(b) && std::get<1>(a) == std::get<1>(b);
}

int find_root(std::vector<int>& parent, int item)
{
    while (parent[item] != item) item = parent[item] = parent[parent[item]];
    return item;
}

void join(std::vector<int>& parent, int a, int b)
{
    a = find_root(parent, a);
    b = find_root(parent, b);
    parent[std::max(a, b)] = std::min(a, b);
}

}  // namespace

BodySurface::BodySurface(const TriangleMesh& mesh) : vertices_(mesh.vertices), faces_(mesh.faces)
{
    const std::vector<int> first = first_coincident_vertex(mesh.vertices);
    for (Face& face : faces_)
        for (int& vertex : face) vertex = first[vertex];
    find_face_normals();
    const Sides sides = sorted_sides();
    find_neighbours(sides);
    find_edge_normals(sides);
    find_groups();
    find_corner_normals();
}

void BodySurface::deform(const std::vector<Vec3>& vertices)
{
    if (sides_.empty()) sides_ = sorted_sides();
    vertices_ = vertices;
    find_face_normals();
    find_edge_normals(sides_);
    find_corner_normals();
}

void BodySurface::find_face_normals()
{
    face_normals_.assign(faces_.size(), Vec3::Zero());
    vertex_normals_.assign(vertices_.size(), Vec3::Zero());
    for (int f = 0; f < triangle_count(); ++f) {
        const Vec3 u = corner(f, 1) - corner(f, 0), v = corner(f, 2) - corner(f, 0), area = u.cross(v);
        if (!(area.norm() > 1e-12 * std::max(u.squaredNorm(), v.squaredNorm()))) continue;
        face_normals_[f] = area.normalized();
        for (int k = 0; k < 3; ++k)
            vertex_normals_[faces_[f][k]] +=
                corner_angle(corner(f, k), corner(f, (k + 1) % 3), corner(f, (k + 2) % 3)) * face_normals_[f];
    }
}

// Lists the sides of all faces with an area, sorted so that the sides of one edge follow each other.
BodySurface::Sides BodySurface::sorted_sides() const
{
    Sides sides;
    for (int f = 0; f < triangle_count(); ++f)
        for (int k = 0; has_area(f) && k < 3; ++k) {
            const auto [low, high] = std::minmax(faces_[f][k], faces_[f][(k + 1) % 3]);
            sides.emplace_back(low, high, 3 * f + k);
        }
    std::sort(sides.begin(), sides.end());
    return sides;
}

void BodySurface::find_neighbours(const Sides& sides)
{
    neighbour_.assign(faces_.size(), {-1, -1, -1});
    for (std::size_t first = 0, last = 0; first < sides.size(); first = last) {
        while (last < sides.size() && same_edge(sides[last], sides[first])) ++last;
        if (last - first != 2) continue;
        const int side0 = std::get<2>(sides[first]), side1 = std::get<2>(sides[first + 1]);
        if (faces_[side0 / 3][side0 % 3] == faces_[side1 / 3][side1 % 3]) continue;  // opposite orientations
        neighbour_[side0 / 3][side0 % 3] = side1;
        neighbour_[side1 / 3][side1 % 3] = side0;
    }
}

void BodySurface::find_edge_normals(const Sides& sides)
{
    edge_normals_.assign(faces_.size(), {Vec3::Zero(), Vec3::Zero(), Vec3::Zero()});
    for (std::size_t first = 0, last = 0; first < sides.size(); first = last) {
        Vec3 sum = Vec3::Zero();
        for (; last < sides.size() && same_edge(sides[last], sides[first]); ++last)
            sum += face_normals_[std::get<2>(sides[last]) / 3];
        for (std::size_t k = first; k < last; ++k) {
            const int side = std::get<2>(sides[k]);
            edge_normals_[side / 3][side % 3] = sum;
        }
    }
}

bool BodySurface::is_sharp(int triangle, int local) const
{
    const int side = neighbour_[triangle][local];
    const Vec3& normal = face_normals_[triangle];
    const Vec3 to_opposite = corner(side / 3, (side % 3 + 2) % 3) - corner(triangle, local);
    return normal.dot(face_normals_[side / 3]) < ContactNormalTuning::sharp_cosine && to_opposite.dot(normal) < 0;
}

void BodySurface::find_groups()
{
    std::vector<int> parent(3 * faces_.size());
    std::iota(parent.begin(), parent.end(), 0);
    for (int f = 0; f < triangle_count(); ++f)
        for (int k = 0; k < 3; ++k) {
            const int side = neighbour_[f][k];
            if (side < 3 * f || is_sharp(f, k)) continue;
            const int g = side / 3, edge = side % 3;  // edge k of f, in the opposite direction
            join(parent, 3 * f + k, 3 * g + (edge + 1) % 3);
            join(parent, 3 * f + (k + 1) % 3, 3 * g + edge);
        }
    std::vector<int> group_of_vertex(vertices_.size(), -1);
    has_several_groups_.assign(vertices_.size(), false);
    corner_group_.resize(faces_.size());
    for (int f = 0; f < triangle_count(); ++f)
        for (int k = 0; has_area(f) && k < 3; ++k) {
            corner_group_[f][k] = find_root(parent, 3 * f + k);
            int& group = group_of_vertex[faces_[f][k]];
            if (group < 0) group = corner_group_[f][k];
            if (group != corner_group_[f][k]) has_several_groups_[faces_[f][k]] = true;
        }
}

void BodySurface::find_corner_normals()
{
    std::vector<Vec3> sum(3 * faces_.size(), Vec3::Zero());
    for (int f = 0; f < triangle_count(); ++f)
        for (int k = 0; has_area(f) && k < 3; ++k)
            sum[corner_group_[f][k]] +=
                corner_angle(corner(f, k), corner(f, (k + 1) % 3), corner(f, (k + 2) % 3)) * face_normals_[f];
    corner_normals_.resize(faces_.size());
    for (int f = 0; f < triangle_count(); ++f)
        for (int k = 0; has_area(f) && k < 3; ++k)
            corner_normals_[f][k] = unit_or(sum[corner_group_[f][k]], face_normals_[f]);
}

const Vec3& BodySurface::pseudo_normal(int triangle, const ClosestOnTriangle& closest) const
{
    if (closest.feature == TriangleFeature::face) return face_normals_[triangle];
    if (closest.feature == TriangleFeature::edge) return edge_normals_[triangle][closest.local];
    return vertex_normals_[faces_[triangle][closest.local]];
}

Vec3 BodySurface::edge_normal(int triangle, const ClosestOnTriangle& closest, const Vec3& direction) const
{
    const int start = closest.local, end = (start + 1) % 3, side = neighbour_[triangle][start];
    const double w0 = closest.weights[start], w1 = closest.weights[end];
    const Vec3 mine = w0 * corner_normals_[triangle][start] + w1 * corner_normals_[triangle][end];
    if (side < 0) return mine;
    const int other = side / 3, other_end = side % 3, other_start = (other_end + 1) % 3;
    if (corner_group_[triangle][start] == corner_group_[other][other_start] &&
        corner_group_[triangle][end] == corner_group_[other][other_end])
        return mine;
    const Vec3 beyond = w0 * corner_normals_[other][other_start] + w1 * corner_normals_[other][other_end];

    // direction = alpha n_mine + beta n_other + (rounding along the edge), solved in the plane across the edge.
    const Vec3 edge = (corner(triangle, end) - corner(triangle, start)).normalized();
    const Vec3 &n = face_normals_[triangle], &m = face_normals_[other];
    const double determinant = edge.dot(n.cross(m));
    if (std::abs(determinant) < 1e-6) return direction;
    const double alpha = std::max(0.0, edge.dot(direction.cross(m)) / determinant);
    const double beta = std::max(0.0, edge.dot(n.cross(direction)) / determinant);
    return alpha * mine.normalized() + beta * beyond.normalized();
}

Vec3 BodySurface::smooth_normal(int triangle, const ClosestOnTriangle& closest, const Vec3& direction) const
{
    if (closest.feature == TriangleFeature::edge) return unit_or(edge_normal(triangle, closest, direction), direction);
    if (closest.feature == TriangleFeature::corner) {
        // A corner on sharp edges has several normals; the direction to x varies continuously between them.
        const bool sharp = has_several_groups_[faces_[triangle][closest.local]];
        return sharp ? direction : corner_normals_[triangle][closest.local];
    }
    const Corners& normals = corner_normals_[triangle];
    const Vec3& w = closest.weights;
    return unit_or(w[0] * normals[0] + w[1] * normals[1] + w[2] * normals[2], direction);
}

SurfaceContact BodySurface::contact(const Vec3& x, int triangle) const
{
    const ClosestOnTriangle closest_point = closest(x, triangle);
    const Vec3 offset = x - closest_point.point;
    const Vec3& pseudo = pseudo_normal(triangle, closest_point);
    const double distance = std::sqrt(closest_point.squared_distance);
    const double sign = offset.dot(pseudo) < 0 ? -1 : 1;

    Vec3 direction = unit_or(pseudo, face_normals_[triangle]);
    if (closest_point.feature != TriangleFeature::face && distance > least_distance)
        direction = sign / distance * offset;
    const Vec3 smooth = smooth_normal(triangle, closest_point, direction);

    constexpr double smooth_cosine = ContactNormalTuning::smooth_cosine,
                     direction_cosine = ContactNormalTuning::direction_cosine;
    const double agreement = direction.dot(smooth);
    const double t = std::clamp((agreement - direction_cosine) / (smooth_cosine - direction_cosine), 0.0, 1.0);
    const double smooth_share = t * t * (3 - 2 * t);
    SurfaceContact result;
    result.signed_distance = sign * distance;
    result.normal = unit_or(smooth_share * smooth + (1 - smooth_share) * direction, direction);
    result.gap = result.signed_distance * direction.dot(result.normal);
    return result;
}

}  // namespace selvage
