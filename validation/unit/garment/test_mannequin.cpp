#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <utility>

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

double distance_to_vertices(const TriangleMesh& mesh, const Vec3& point)
{
    double nearest = 1e9;
    for (const Vec3& vertex : mesh.vertices) nearest = std::min(nearest, (vertex - point).squaredNorm());
    return std::sqrt(nearest);
}

}  // namespace

TEST_CASE("the mannequin is a sound mesh for every size and arm angle")
{
    using enum BodySize;
    using enum BodyFigure;
    const auto [size, figure, angle] = GENERATE(table<BodySize, BodyFigure, double>({{M, women, 45},
                                                                                     {M, women, 0},
                                                                                     {XS, women, 25},
                                                                                     {XXL, women, 80},
                                                                                     {XXL, men, 65},
                                                                                     {XS, men, 80},
                                                                                     {child110, children, 80},
                                                                                     {child152, children, 0}}));
    CAPTURE(word_of(size), word_of(figure), angle);
    MannequinMeasures measures = mannequin_size(size, figure);
    measures.arm_angle = angle;
    const TriangleMesh mesh = make_mannequin(measures);
    CHECK(is_closed_manifold(mesh));
    CHECK(int(mesh.vertices.size()) - int(mesh.faces.size()) / 2 == 2);      // Genus 0: no arm touches the hip.
    const double bulk = measures.waist * measures.waist * measures.stature;  // a cylinder has 0.080 of it
    CHECK(volume(mesh) / bulk == Approx(0.065).margin(0.020));
    CHECK(smallest_angle(mesh) > 12);

    const std::vector<std::string> names{"head", "neck", "torso", "left_arm", "right_arm", "left_leg", "right_leg"};
    REQUIRE(mesh.parts.size() == names.size());
    int next_face = 0;
    for (std::size_t part = 0; part < names.size(); ++part) {
        CHECK(mesh.parts[part].name == names[part]);
        CHECK(mesh.parts[part].first_face == next_face);
        CHECK(mesh.parts[part].face_count > 200);
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

    double low = 1e9, high = -1e9;
    for (const Vec3& vertex : mesh.vertices) {
        low = std::min(low, vertex.z());
        high = std::max(high, vertex.z());
    }
    CHECK(std::abs(low) < 1e-3);
    CHECK(high - low == Approx(measures.stature).epsilon(0.005));
    CHECK((at.shoulder_joint[0] - at.shoulder_joint[1]).norm() == Approx(measures.shoulder_width).epsilon(0.02));
    for (const Vec3& point : {at.shoulder_point[0], at.shoulder_point[1], at.armpit[0], at.neck_side[0]})
        CHECK(distance_to_vertices(mesh, point) < 0.012);

    // The wrist is where the arm is thinnest between elbow and hand.
    const Vec3 along = at.arm_direction[0], across = Vec3::UnitY().cross(along);
    double thinnest = 1e9, wrist = 0;
    for (double t = 0.7 * measures.arm_length; t < measures.arm_length + 0.05; t += 0.004) {
        std::vector<Vec3> section = slice(mesh, arms, along, along.dot(at.shoulder_joint[0]) + t);
        std::erase_if(section, [](const Vec3& point) { return point.x() < 0; });
        const double around = tape_girth(section, Vec3::UnitY(), across);
        if (around < thinnest) {
            thinnest = around;
            wrist = t;
        }
    }
    CHECK(wrist == Approx(along.dot(at.wrist[0] - at.shoulder_joint[0])).epsilon(0.02));
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

TEST_CASE("sizes grow from one to the next, and sizes of children need no figure")
{
    const auto grows = [](const MannequinMeasures& a, const MannequinMeasures& b) {
        return a.stature < b.stature && a.bust < b.bust && a.waist < b.waist && a.hips < b.hips &&
               a.shoulder_width < b.shoulder_width && a.neck < b.neck && a.arm_length < b.arm_length;
    };
    for (const BodyFigure figure : {BodyFigure::women, BodyFigure::men})
        for (int k = int(BodySize::XS); k < int(BodySize::XXL); ++k)
            CHECK(grows(mannequin_size(BodySize(k), figure), mannequin_size(BodySize(k + 1), figure)));
    for (int k = int(BodySize::child110); k < int(BodySize::child152); ++k)
        CHECK(grows(mannequin_size(BodySize(k)), mannequin_size(BodySize(k + 1))));
    CHECK(mannequin_size(BodySize::M).figure == BodyFigure::women);
    CHECK(mannequin_size(BodySize::child122).figure == BodyFigure::children);
    CHECK(mannequin_size(BodySize::child122).stature == Approx(1.22));
    CHECK(mannequin_size(BodySize::child130).bust == Approx(0.6667).margin(0.001));
    CHECK_THROWS_AS(mannequin_size(BodySize::child122, BodyFigure::men), InputError);
    CHECK_THROWS_AS(mannequin_size(BodySize::M, BodyFigure::children), InputError);
}

TEST_CASE("measures beyond the mannequin's range are refused")
{
    MannequinMeasures measures;
    measures.bust = 92;
    CHECK_THROWS_AS(make_mannequin(measures), InputError);
    measures = {};
    measures.arm_angle = 85;
    CHECK_THROWS_AS(mannequin_landmarks(measures), InputError);
}
