#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <utility>

#include <Eigen/Geometry>

#include "host/garment/catalogue.hpp"
#include "host/mannequin/mannequin.hpp"
#include "io/errors.hpp"
#include "validation/unit/catch.hpp"

using namespace selvage;

namespace {

bool is_arm(const std::string& part) { return part == "left_arm" || part == "right_arm"; }

std::vector<Face> faces_where(const TriangleMesh& mesh, bool arms)
{
    std::vector<Face> faces;
    for (const MeshPart& part : mesh.parts)
        if (is_arm(part.name) == arms)
            faces.insert(faces.end(), mesh.faces.begin() + part.first_face,
                         mesh.faces.begin() + part.first_face + part.face_count);
    return faces;
}

double volume(const TriangleMesh& mesh)
{
    double sum = 0;
    for (const Face& f : mesh.faces) sum += mesh.vertices[f[0]].dot(mesh.vertices[f[1]].cross(mesh.vertices[f[2]])) / 6;
    return sum;
}

/// Points where the faces' edges cross the plane normal . p = height.
std::vector<Vec3> slice(const TriangleMesh& mesh, const std::vector<Face>& faces, const Vec3& normal, double height)
{
    std::vector<Vec3> points;
    for (const Face& face : faces)
        for (int corner = 0; corner < 3; ++corner) {
            const Vec3 a = mesh.vertices[face[corner]], b = mesh.vertices[face[(corner + 1) % 3]];
            const double da = normal.dot(a) - height, db = normal.dot(b) - height;
            if ((da < 0) != (db < 0)) points.push_back(a + da / (da - db) * (b - a));
        }
    return points;
}

/// Perimeter of the convex hull, as the mean width over all directions (Cauchy's formula) times pi.
double tape_girth(const std::vector<Vec3>& points, const Vec3& axis_u, const Vec3& axis_v)
{
    const int direction_count = 90;
    double widths = 0;
    for (int k = 0; k < direction_count; ++k) {
        const double angle = M_PI * k / direction_count;
        const Vec3 direction = std::cos(angle) * axis_u + std::sin(angle) * axis_v;
        double low = 1e9, high = -1e9;
        for (const Vec3& point : points) {
            low = std::min(low, direction.dot(point));
            high = std::max(high, direction.dot(point));
        }
        widths += high - low;
    }
    return M_PI * widths / direction_count;
}

double smallest_angle(const TriangleMesh& mesh)
{
    double largest_cosine = -1;
    for (const Face& f : mesh.faces)
        for (int k = 0; k < 3; ++k) {
            const Vec3 a = mesh.vertices[f[k]];
            const Vec3 u = mesh.vertices[f[(k + 1) % 3]] - a, v = mesh.vertices[f[(k + 2) % 3]] - a;
            largest_cosine = std::max(largest_cosine, u.normalized().dot(v.normalized()));
        }
    return std::acos(largest_cosine) * 180 / M_PI;
}

/// Every directed edge occurs once, and so does its opposite.
bool is_closed_manifold(const TriangleMesh& mesh)
{
    std::set<std::pair<int, int>> edges;
    for (const Face& f : mesh.faces)
        for (int k = 0; k < 3; ++k)
            if (!edges.insert({f[k], f[(k + 1) % 3]}).second) return false;
    return std::all_of(edges.begin(), edges.end(), [&](const auto& edge) {
        return edges.count({edge.second, edge.first}) == 1;
    });
}

/// Parity of the faces above the point.
bool is_inside(const TriangleMesh& mesh, const Vec3& point)
{
    int crossings = 0;
    for (const Face& f : mesh.faces) {
        const Vec3 &a = mesh.vertices[f[0]], &b = mesh.vertices[f[1]], &c = mesh.vertices[f[2]];
        if (std::max({a.z(), b.z(), c.z()}) < point.z() || std::abs(a.x() - point.x()) > 0.05 ||
            std::abs(a.y() - point.y()) > 0.05)
            continue;
        auto turn = [&](const Vec3& from, const Vec3& to) {
            return (from.x() - point.x()) * (to.y() - point.y()) - (from.y() - point.y()) * (to.x() - point.x());
        };
        const double u = turn(b, c), v = turn(c, a), w = turn(a, b);
        if ((u < 0 || v < 0 || w < 0) && (u > 0 || v > 0 || w > 0)) continue;
        if ((u * a.z() + v * b.z() + w * c.z()) / (u + v + w) > point.z()) ++crossings;
    }
    return crossings % 2 == 1;
}

double distance_to_vertices(const TriangleMesh& mesh, const Vec3& point)
{
    double nearest = 1e9;
    for (const Vec3& vertex : mesh.vertices) nearest = std::min(nearest, (vertex - point).squaredNorm());
    return std::sqrt(nearest);
}

std::vector<Vec2> sample_edge(const PatternPanel& panel, int edge, int chord_count = 40)
{
    const PatternEdge& e = panel.edges[edge];
    const Vec2 a = panel.vertices[e.start], b = panel.vertices[e.end];
    std::vector<Vec2> points;
    for (int k = 0; k <= chord_count; ++k) {
        const double t = double(k) / chord_count, s = 1 - t;
        Vec2 point = s * a + t * b;
        if (e.curve == EdgeCurve::quadratic) point = s * s * a + 2 * s * t * e.control[0] + t * t * b;
        if (e.curve == EdgeCurve::cubic)
            point = s * s * s * a + 3 * s * s * t * e.control[0] + 3 * s * t * t * e.control[1] + t * t * t * b;
        points.push_back(point);
    }
    return points;
}

double length(const std::vector<Vec2>& line)
{
    double sum = 0;
    for (std::size_t k = 1; k < line.size(); ++k) sum += (line[k] - line[k - 1]).norm();
    return sum;
}

std::vector<Vec2> outline(const PatternPanel& panel)
{
    std::vector<Vec2> points;
    for (int edge = 0; edge < int(panel.edges.size()); ++edge) {
        const std::vector<Vec2> line = sample_edge(panel, edge);
        points.insert(points.end(), line.begin(), line.end() - 1);
    }
    return points;
}

double signed_area(const std::vector<Vec2>& polygon)
{
    double twice = 0;
    for (std::size_t k = 0; k < polygon.size(); ++k) {
        const Vec2 a = polygon[k], b = polygon[(k + 1) % polygon.size()];
        twice += a.x() * b.y() - a.y() * b.x();
    }
    return twice / 2;
}

bool contains(const std::vector<Vec2>& polygon, const Vec2& point)
{
    bool inside = false;
    for (std::size_t k = 0; k < polygon.size(); ++k) {
        const Vec2 a = polygon[k], b = polygon[(k + 1) % polygon.size()];
        if ((a.y() > point.y()) == (b.y() > point.y())) continue;
        if (point.x() < a.x() + (point.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x())) inside = !inside;
    }
    return inside;
}

Vec3 place(const PatternPanel& panel, const Vec2& point)
{
    Vec3 rolled(point.x(), point.y(), 0);
    if (panel.wrap) {
        const double radius = panel.wrap->radius, angle = (point.x() - panel.wrap->x0) / radius;
        rolled = {panel.wrap->x0 + radius * std::sin(angle), point.y(),
                  (panel.wrap->behind ? 1 : -1) * radius * (1 - std::cos(angle))};
    }
    return panel.rotation * rolled + panel.translation;
}

std::vector<Vec3> start_points(const PatternPanel& panel, double spacing)
{
    std::vector<Vec3> points;
    const std::vector<Vec2> polygon = outline(panel);
    for (std::size_t k = 0; k < polygon.size(); k += 4) points.push_back(place(panel, polygon[k]));
    for (double x = -0.4; x < 0.4; x += spacing)
        for (double y = -1; y < 0.4; y += spacing)
            if (contains(polygon, {x, y})) points.push_back(place(panel, {x, y}));
    return points;
}

}  // namespace

TEST_CASE("the mannequin is a sound mesh for every size and arm angle")
{
    const auto [size, angle] = GENERATE(table<BodySize, double>(
        {{BodySize::M, 45}, {BodySize::M, 0}, {BodySize::L, 25}, {BodySize::S, 65}, {BodySize::L, 80}}));
    CAPTURE(word_of(size), angle);
    MannequinMeasures measures = mannequin_size(size);
    measures.arm_angle = angle;
    const TriangleMesh mesh = make_mannequin(measures);
    CHECK(mesh.faces.size() >= 10000);
    CHECK(is_closed_manifold(mesh));
    CHECK(int(mesh.vertices.size()) - int(mesh.faces.size()) / 2 == 2);  // Genus 0: no arm touches the hip.
    CHECK(volume(mesh) == Approx(0.065).margin(0.025));
    CHECK(smallest_angle(mesh) > 12);

    const std::vector<std::string> names{"head", "neck", "torso", "left_arm", "right_arm", "left_leg", "right_leg"};
    REQUIRE(mesh.parts.size() == names.size());
    int next_face = 0;
    for (std::size_t part = 0; part < names.size(); ++part) {
        CHECK(mesh.parts[part].name == names[part]);
        CHECK(mesh.parts[part].first_face == next_face);
        CHECK(mesh.parts[part].face_count > 300);
        next_face += mesh.parts[part].face_count;
    }
    CHECK(next_face == int(mesh.faces.size()));
}

TEST_CASE("the mannequin has the requested measures")
{
    const std::string size = GENERATE("S", "M", "L", "M, altered");
    CAPTURE(size);
    MannequinMeasures measures = mannequin_size(find_word<BodySize>(size.substr(0, 1)).value());
    if (size == "M, altered") {
        measures.waist *= 1.08;
        measures.neck *= 0.96;
        measures.shoulder_width *= 1.05;
        measures.arm_length *= 1.04;
    }
    const TriangleMesh mesh = make_mannequin(measures);
    const MannequinLandmarks at = mannequin_landmarks(measures);
    const std::vector<Face> trunk = faces_where(mesh, false), arms = faces_where(mesh, true);
    auto girth = [&](double height) {
        return tape_girth(slice(mesh, trunk, Vec3::UnitZ(), height), Vec3::UnitX(), Vec3::UnitY());
    };
    CHECK(girth(at.bust_height) == Approx(measures.bust).epsilon(0.01));
    CHECK(girth(at.waist_height) == Approx(measures.waist).epsilon(0.01));
    CHECK(girth(at.hip_height) == Approx(measures.hips).epsilon(0.01));
    CHECK(girth(at.neck_height) == Approx(measures.neck).epsilon(0.01));

    double low = 1e9, high = -1e9;
    for (const Vec3& vertex : mesh.vertices) {
        low = std::min(low, vertex.z());
        high = std::max(high, vertex.z());
    }
    CHECK(std::abs(low) < 1e-3);
    CHECK(high - low == Approx(measures.stature).epsilon(0.005));
    CHECK((at.shoulder_point[0] - at.shoulder_point[1]).norm() == Approx(measures.shoulder_width).epsilon(0.02));
    for (const Vec3& point : {at.shoulder_point[0], at.shoulder_point[1], at.armpit[0], at.neck_side[0]})
        CHECK(distance_to_vertices(mesh, point) < 0.012);

    // The wrist is where the arm is thinnest between elbow and hand.
    const Vec3 along = at.arm_direction[0], across = Vec3::UnitY().cross(along);
    double thinnest = 1e9, wrist = 0;
    for (double t = 0.7 * measures.arm_length; t < measures.arm_length + 0.05; t += 0.004) {
        std::vector<Vec3> section = slice(mesh, arms, along, along.dot(at.shoulder_point[0]) + t);
        std::erase_if(section, [](const Vec3& point) { return point.x() < 0; });
        const double around = tape_girth(section, Vec3::UnitY(), across);
        if (around < thinnest) {
            thinnest = around;
            wrist = t;
        }
    }
    CHECK(wrist == Approx(measures.arm_length).epsilon(0.02));
}

TEST_CASE("the mannequin faces -y with its left at +x")
{
    const MannequinLandmarks at = mannequin_landmarks(mannequin_size(BodySize::M));
    const TriangleMesh mesh = make_mannequin(mannequin_size(BodySize::M));
    double toes = 0, heel = 0;
    for (const Vec3& vertex : mesh.vertices) {
        if (vertex.z() > 0.05) continue;
        toes = std::min(toes, vertex.y());
        heel = std::max(heel, vertex.y());
    }
    CHECK(-toes > 1.5 * heel);
    CHECK(at.wrist[0].x() > 0.3);
    CHECK(at.wrist[1].x() < -0.3);
    CHECK(mesh.vertices[mesh.faces[mesh.parts[3].first_face][0]].x() > 0);
}

TEST_CASE("measures beyond the mannequin's range and unknown names are refused")
{
    MannequinMeasures measures;
    measures.bust = 92;
    CHECK_THROWS_AS(make_mannequin(measures), InputError);
    measures = {};
    measures.arm_angle = 85;
    CHECK_THROWS_AS(mannequin_landmarks(measures), InputError);
    CHECK_THROWS_AS(builtin_pattern("tshrt", BodySize::M), InputError);
}

TEST_CASE("built-in patterns have closed counter-clockwise outlines and seams of equal length")
{
    const std::string name = GENERATE(from_range(builtin_pattern_names()));
    const BodySize size = GENERATE(BodySize::S, BodySize::M, BodySize::L);
    CAPTURE(name, word_of(size));
    const Pattern pattern = builtin_pattern(name, size);
    CHECK(pattern.panels.size() == (name == "tshirt" ? 4 : 2));
    CHECK(pattern.stitches.size() == (name == "tshirt" ? 10 : 4));
    double area = 0;
    for (const PatternPanel& panel : pattern.panels) {
        for (std::size_t edge = 0; edge < panel.edges.size(); ++edge)
            CHECK(panel.edges[edge].end == panel.edges[(edge + 1) % panel.edges.size()].start);
        const double panel_area = signed_area(outline(panel));
        CHECK(panel_area > 0.05);
        area += panel_area;
        CHECK((panel.rotation.transpose() * panel.rotation - Mat3::Identity()).norm() < 1e-12);
        CHECK(panel.rotation.determinant() == Approx(1));
    }
    if (name == "tshirt" && size == BodySize::M) CHECK(area == Approx(1.05).margin(0.05));

    std::set<std::pair<int, int>> sewn;
    for (const PatternStitch& stitch : pattern.stitches) {
        const double a = length(sample_edge(pattern.panels[stitch.a.panel], stitch.a.edge));
        const double b = length(sample_edge(pattern.panels[stitch.b.panel], stitch.b.edge));
        CHECK(a == Approx(b).epsilon(0.005));
        CHECK(sewn.insert({stitch.a.panel, stitch.a.edge}).second);
        CHECK(sewn.insert({stitch.b.panel, stitch.b.edge}).second);
    }
}

TEST_CASE("built-in patterns start outside the mannequin, facing away from it, with seams that do not cross it")
{
    const std::string name = GENERATE(from_range(builtin_pattern_names()));
    const BodySize size = GENERATE(BodySize::S, BodySize::M, BodySize::L);
    CAPTURE(name, word_of(size));
    const Pattern pattern = builtin_pattern(name, size);
    const TriangleMesh body = make_mannequin(mannequin_size(size));
    double gap = 1e9;
    bool inside = false;
    for (const PatternPanel& panel : pattern.panels)
        for (const Vec3& point : start_points(panel, 0.06)) {
            inside = inside || is_inside(body, point);
            gap = std::min(gap, distance_to_vertices(body, point));
        }
    CHECK_FALSE(inside);
    CHECK(gap > 0.010);
    CHECK(pattern.panels[0].rotation.col(2).y() < -0.9);
    CHECK(pattern.panels[1].rotation.col(2).y() > 0.9);

    int pair_count = 0, crossing_count = 0;
    double widest = 0;
    for (const PatternStitch& stitch : pattern.stitches) {
        const PatternPanel &panel_a = pattern.panels[stitch.a.panel], &panel_b = pattern.panels[stitch.b.panel];
        const std::vector<Vec2> a = sample_edge(panel_a, stitch.a.edge, 10);
        const std::vector<Vec2> b = sample_edge(panel_b, stitch.b.edge, 10);
        for (int k = 0; k <= 10; ++k) {
            const Vec3 from = place(panel_a, a[k]), to = place(panel_b, b[10 - k]);
            ++pair_count;
            crossing_count += is_inside(body, 0.5 * (from + to)) || is_inside(body, 0.25 * from + 0.75 * to) ||
                              is_inside(body, 0.75 * from + 0.25 * to);
            widest = std::max(widest, (from - to).norm());
        }
    }
    CHECK(crossing_count <= pair_count / 10);
    CHECK(widest < 0.40);
}

TEST_CASE("the t-shirt's sleeves roll around the arms with their underarm edges below")
{
    const MannequinLandmarks at = mannequin_landmarks(mannequin_size(BodySize::M));
    const Pattern pattern = builtin_pattern("tshirt", BodySize::M);
    for (int hand = 0; hand < 2; ++hand) {
        const PatternPanel& sleeve = pattern.panels[2 + hand];
        CHECK(sleeve.name == (hand == 0 ? "left_sleeve" : "right_sleeve"));
        const Vec3 joint = at.shoulder_joint[hand], along = at.arm_direction[hand];
        const Vec3 below = Vec3(-Vec3::UnitZ() + along.z() * along).normalized();
        for (int edge : {1, 4})
            for (const Vec2& point : sample_edge(sleeve, edge, 6)) {
                const Vec3 offset = place(sleeve, point) - joint, radial = offset - along.dot(offset) * along;
                CHECK(radial.norm() == Approx(sleeve.wrap->radius).epsilon(1e-6));
                CHECK(radial.normalized().dot(below) > 0.6);
            }
        CHECK(along.dot(place(sleeve, sleeve.vertices[3]) - joint) < 0.07);
        CHECK(sleeve.wrap->radius > at.upper_arm_radius + 0.015);
    }
}
