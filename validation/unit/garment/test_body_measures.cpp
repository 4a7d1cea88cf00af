#include <algorithm>
#include <cmath>
#include <string>

#include <Eigen/Geometry>

#include "host/body/anatomy.hpp"
#include "host/body/body_measures.hpp"
#include "host/body/body_report.hpp"
#include "host/body/geodesic.hpp"
#include "host/body/merge_tree.hpp"
#include "host/mannequin/mannequin.hpp"
#include "host/mesh/body_tessellation.hpp"
#include "host/mesh/convex_hull.hpp"
#include "host/mesh/surface_net.hpp"
#include "io/errors.hpp"
#include "validation/unit/catch.hpp"

using namespace selvage;

namespace {

const InputPlace here{"body.obj", 0, 0, {}};

TriangleMesh mannequin_with(double arm_angle, BodySize size = BodySize::M)
{
    MannequinMeasures asked = mannequin_size(size);
    asked.arm_angle = arm_angle;
    return make_mannequin(asked);
}

const TriangleMesh& mannequin()
{
    static const TriangleMesh mesh = mannequin_with(45);
    return mesh;
}

const BodyMeasures& measured()
{
    static const BodyMeasures measures = measure_body(mannequin(), here);
    return measures;
}

double girth(const BodyMeasures& measures, const char* name)
{
    const BodyMeasure* found = measures.girth(name);
    return found ? found->value : 0;
}

Vec3 at(const BodyMeasures& measures, const std::string& name)
{
    const Landmark* found = measures.landmark(name);
    REQUIRE(found);
    return found->position;
}

std::string refusal(const TriangleMesh& mesh)
{
    try {
        measure_body(mesh, here);
    } catch (const InputError& error) {
        return error.what();
    }
    return "measured";
}

// A part of the mannequin and that of a measured vertex, as far as both name it.
bool same_part(const std::string& made, const std::string& found)
{
    const bool left = found.starts_with("left");
    if (found.ends_with("arm") || found.ends_with("hand")) return made == (left ? "left_arm" : "right_arm");
    if (found.ends_with("leg") || found.ends_with("foot")) return made == (left ? "left_leg" : "right_leg");
    return made == "torso" || made == "neck" || made == "head";
}

double box_distance(const Vec3& x, const Vec3& low, const Vec3& high)
{
    return ((x - (low + high) / 2).cwiseAbs() - (high - low) / 2).maxCoeff();
}

}  // namespace

TEST_CASE("the hull of points has the corners and the perimeter of the square around them", "[body]")
{
    const std::vector<Vec2> points{{0, 0}, {1, 0}, {0.5, 0}, {1, 1}, {0.2, 0.7}, {0, 1}, {0, 0}, {0, 0.4}};
    const std::vector<Vec2> hull = convex_hull(points);
    CHECK(hull == std::vector<Vec2>{{0, 0}, {1, 0}, {1, 1}, {0, 1}});
    CHECK(perimeter(hull) == Approx(4));
}

TEST_CASE("points that nearly lie on each other leave no inner point on the hull", "[body]")
{
    for (int turn = 0; turn < 150; ++turn) {  // with rounded cross products 7 of these polygons keep inner points
        std::vector<Vec2> points;
        for (int k = 0; k < 200; ++k) {
            const double angle = 2 * M_PI * k / 200 + turn, radius = k % 2 ? 0.5 : 1;
            const double x = radius * std::cos(angle), y = radius * std::sin(angle);
            points.emplace_back(x, y);
            points.emplace_back(std::nextafter(x, k % 3 - 1.0), std::nextafter(y, k % 5 - 2.0));
        }
        CHECK(perimeter(convex_hull(points)) == Approx(200 * std::sin(M_PI / 100)).epsilon(1e-9));
    }
}

TEST_CASE("geodesic distances on a sphere are arcs of great circles within 1.5 %", "[body]")
{
    const Skin skin = make_skin(sphere_mesh(Vec3::Zero(), 1, 4));
    const std::vector<double> distance = geodesic_distances(skin, {{0, 0}});
    for (std::size_t v = 0; v < distance.size(); ++v) {
        const double arc = std::acos(std::clamp(skin.vertices[v].dot(skin.vertices[0]), -1.0, 1.0));
        CHECK(distance[v] == Approx(arc).epsilon(0.015).margin(0.007));
    }
}

TEST_CASE("a merge tree has a branch for each maximum that is prominent enough", "[body]")
{
    const Skin skin = make_skin(sphere_mesh(Vec3::Zero(), 1, 4));
    std::vector<double> values;
    for (const Vec3& x : skin.vertices) values.push_back(std::abs(x.z()) + 0.2 * x.z());
    const std::vector<Branch> branches = merge_tree(skin, values, 0.5);
    REQUIRE(branches.size() == 2);
    CHECK(skin.vertices[branches[0].tip].z() > 0.99);
    CHECK(skin.vertices[branches[1].tip].z() < -0.99);
    CHECK(branches[1].into == branches[0].tip);
    CHECK(std::abs(skin.vertices[branches[1].saddle].z()) < 0.1);
    CHECK(branches[1].persistence == Approx(0.8).margin(0.1));
    CHECK(merge_tree(skin, values, 0.9).size() == 1);
}

TEST_CASE("the girths of mannequins of all sizes are measured as they were asked for, within a percent", "[body]")
{
    using enum BodySize;
    using enum BodyFigure;
    for (const auto& [size, figure] : {std::pair{XS, women},
                                       {S, women},
                                       {M, women},
                                       {L, women},
                                       {XXL, women},
                                       {XS, men},
                                       {M, men},
                                       {XL, men},
                                       {XXL, men},
                                       {child110, children},
                                       {child122, children},
                                       {child140, children},
                                       {child152, children}}) {
        CAPTURE(word_of(size), word_of(figure));
        const MannequinMeasures asked = mannequin_size(size, figure);
        const BodyMeasures found = measure_body(make_mannequin(asked), here);
        CHECK(girth(found, "neck") == Approx(asked.neck).epsilon(0.01));
        CHECK(found.length("arm_length")->value == Approx(asked.arm_length).epsilon(0.04));
        CHECK(found.length("shoulder_width")->value == Approx(asked.shoulder_width).epsilon(0.16));
        CHECK(found.height == Approx(asked.stature).epsilon(0.002));
        CHECK(girth(found, "bust") == Approx(asked.bust).epsilon(0.01));
        CHECK(girth(found, "waist") == Approx(asked.waist).epsilon(0.01));
        CHECK(girth(found, "hips") == Approx(asked.hips).epsilon(0.01));
        CHECK(std::ranges::all_of(found.missing, [](const std::string& name) { return name == "underbust"; }));
    }
}

TEST_CASE("landmarks of a mannequin lie where it was made", "[body]")
{
    const MannequinLandmarks made = mannequin_landmarks({});
    const std::array<std::string, 2> sides{"left_", "right_"};
    for (int k = 0; k < 2; ++k) {
        CHECK((at(measured(), sides[k] + "wrist") - made.wrist[k]).norm() < 0.03);
        CHECK((at(measured(), sides[k] + "armpit") - made.armpit[k]).norm() < 0.06);
        CHECK((at(measured(), sides[k] + "neck_side") - made.neck_side[k]).norm() < 0.03);
    }
    CHECK(at(measured(), "waist_front").z() == Approx(made.waist_height).margin(0.02));
    CHECK(at(measured(), "hips_back").z() == Approx(made.hip_height).margin(0.02));
    CHECK(at(measured(), "bust_front").z() == Approx(made.bust_height).margin(0.015));
    CHECK(at(measured(), "crotch").z() == Approx(made.crotch_height).margin(0.04));
    CHECK(at(measured(), "neck_front").y() < at(measured(), "neck_back").y());
    CHECK(at(measured(), "neck_front").z() < at(measured(), "neck_back").z());
}

TEST_CASE("nearly all vertices of a mannequin get the part that it was made with", "[body]")
{
    int right = 0, all = 0;
    for (const MeshPart& part : mannequin().parts)
        for (int f = part.first_face; f < part.first_face + part.face_count; ++f)
            for (const int v : mannequin().faces[f]) {
                ++all;
                right += same_part(part.name, text_of(measured().regions[v]));
            }
    CHECK(right > 0.95 * all);
    for (const std::string_view word : words_of<BodyRegion>())
        CHECK((word == "loose") ==
              std::ranges::none_of(measured().regions, [&](BodyRegion r) { return word_of(r) == word; }));
}

TEST_CASE("a body has the same measures with its arms raised, spread and hanging", "[body]")
{
    for (const double angle : {0.0, 65.0, 80.0}) {
        const BodyMeasures found = measure_body(mannequin_with(angle), here);
        for (const char* name : {"bust", "waist", "hips", "neck", "thigh", "calf"})
            CHECK(girth(found, name) == Approx(girth(measured(), name)).epsilon(0.02));
        CHECK(girth(found, "wrist") == Approx(girth(measured(), "wrist")).epsilon(0.02));
        CHECK(found.length("inseam")->value == Approx(measured().length("inseam")->value).epsilon(0.01));
        CHECK(at(found, "left_armpit").z() == Approx(at(found, "right_armpit").z()).margin(0.01));
    }
}

TEST_CASE("arms are equally long in all poses, and their centre lines run from the armpits to the palms", "[body]")
{
    for (const double angle : {0.0, 25.0, 65.0, 80.0}) {
        const BodyMeasures found = measure_body(mannequin_with(angle), here);
        CHECK(found.length("arm_length")->value == Approx(measured().length("arm_length")->value).epsilon(0.035));
        const LimbLine* arm = found.limb("left_arm");
        REQUIRE(arm);
        REQUIRE(arm->sections.size() > 15);
        double length = 0;
        for (std::size_t k = 1; k < arm->sections.size(); ++k)
            length += (arm->sections[k].middle - arm->sections[k - 1].middle).norm();
        CHECK(length == Approx(0.57).margin(0.08));
        CHECK((arm->sections.front().middle - at(found, "left_armpit")).norm() < 0.09);
        CHECK((arm->sections.back().middle - at(found, "left_hand_tip")).norm() < 0.16);
        CHECK(arm->sections.front().girth > 1.5 * girth(found, "wrist"));
    }
    const LimbLine* leg = measured().limb("right_leg");
    REQUIRE(leg);
    CHECK(leg->sections.front().girth == Approx(girth(measured(), "thigh")).epsilon(0.02));
    CHECK(leg->sections.front().middle.z() > leg->sections.back().middle.z() + 0.65);
    CHECK(leg->sections.front().middle.x() < -0.05);
    CHECK(!measured().limb("tail"));
}

TEST_CASE("measures do not depend on where the body stands and which way it faces", "[body]")
{
    const Eigen::AngleAxisd turn(2.2, Vec3::UnitZ());
    const Vec3 shift(3, -1, 0.5);
    TriangleMesh turned = mannequin();
    for (Vec3& x : turned.vertices) x = turn * x + shift;
    const BodyMeasures found = measure_body(turned, here);
    for (const BodyMeasure& girth_there : measured().girths)
        CHECK(girth(found, girth_there.name.c_str()) == Approx(girth_there.value).epsilon(0.003));
    for (const Landmark& landmark : measured().landmarks)
        CHECK((at(found, landmark.name) - (turn * landmark.position + shift)).norm() < 0.01);
}

TEST_CASE("a body without feet faces the way in which its neck leans", "[body]")
{
    const Eigen::AngleAxisd turn(-0.7, Vec3::UnitZ());
    TriangleMesh mesh = mannequin();
    mesh.parts.clear();
    std::erase_if(mesh.faces, [&](const Face& face) { return mesh.vertices[face[0]].z() < 0.12; });
    for (Vec3& x : mesh.vertices) x = turn * x;
    const BodyMeasures found = measure_body(mesh, here);
    const Vec3 front = found.frame.to_file(-Vec3::UnitY()) - found.frame.to_file(Vec3::Zero());
    CHECK((front - turn * -Vec3::UnitY()).norm() < 0.02);
    CHECK(girth(found, "hips") == Approx(girth(measured(), "hips")).epsilon(0.005));
    CHECK(std::ranges::find(found.missing, "ankle") != found.missing.end());
}

TEST_CASE("a body and its mirror image have the same girths", "[body]")
{
    TriangleMesh mirrored = mannequin();
    for (Vec3& x : mirrored.vertices) x.x() = -x.x();
    for (Face& face : mirrored.faces) std::swap(face[1], face[2]);
    const BodyMeasures found = measure_body(mirrored, here);
    for (const BodyMeasure& there : measured().girths)
        CHECK(girth(found, there.name.c_str()) == Approx(there.value).epsilon(0.005));
}

TEST_CASE("one raised arm does not turn a body", "[body]")
{
    MannequinMeasures asked;
    asked.arm_angle = 60;
    TriangleMesh mesh = make_mannequin(asked);
    const std::vector<Vec3> up = mannequin_with_arms(mesh, asked, 10);
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
        if (mesh.vertices[v].x() > 0) mesh.vertices[v] = up[v];
    const BodyMeasures found = measure_body(mesh, here);
    CHECK(std::abs(found.frame.azimuth) < 0.02);
    CHECK(at(found, "left_wrist").z() > at(found, "right_wrist").z() + 0.3);
    CHECK(girth(found, "bust") == Approx(girth(measured(), "bust")).epsilon(0.02));
}

TEST_CASE("over a belly the waist is the hollow of the back and the hips are the seat", "[body]")
{
    TriangleMesh mesh = mannequin();
    for (Vec3& x : mesh.vertices) {
        const double middle = std::exp(-std::pow((x.z() - 1.03) / 0.13, 2));
        if (std::abs(x.x()) < 0.2 && x.y() < 0) x.y() *= 1 + 1.2 * middle;
    }
    const BodyMeasures found = measure_body(mesh, here);
    CHECK(found.girth("waist")->where.starts_with("hollow of the back"));
    CHECK(at(found, "waist_back").z() < at(found, "bust_back").z() - 0.08);
    CHECK(at(found, "hips_back").z() < 0.95);
    CHECK(girth(found, "waist") > 1.1 * girth(measured(), "waist"));
}

TEST_CASE("loose pieces beside a body are told and not measured", "[body]")
{
    TriangleMesh mesh = mannequin();
    const TriangleMesh ball = sphere_mesh(Vec3(0.3, 0, 1.9), 0.05, 2);
    const int first = int(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), ball.vertices.begin(), ball.vertices.end());
    for (const Face& face : ball.faces) mesh.faces.push_back({face[0] + first, face[1] + first, face[2] + first});
    const BodyMeasures found = measure_body(mesh, here);
    CHECK(found.height == Approx(measured().height));
    CHECK(found.regions.back() == BodyRegion::loose);
    CHECK(measures_text(found, "body.obj").find("loose pieces with") != std::string::npos);
}

TEST_CASE("a girth that runs through a hole says so", "[body]")
{
    TriangleMesh mesh = mannequin();
    std::erase_if(mesh.faces, [&](const Face& face) {
        return (mesh.vertices[face[0]] - at(measured(), "waist_front")).norm() < 0.03;
    });
    mesh.parts.clear();
    const BodyMeasures found = measure_body(mesh, here);
    CHECK(found.open_edges > 0.1);
    CHECK(found.girth("waist")->where.find("over a hole") != std::string::npos);
    CHECK(found.girth("hips")->where.find("over a hole") == std::string::npos);
    CHECK(girth(found, "waist") == Approx(girth(measured(), "waist")).epsilon(0.02));
}

TEST_CASE("what is no body is refused with what was not found", "[body]")
{
    CHECK(refusal({}).find("without area") != std::string::npos);
    CHECK(refusal(sphere_mesh(Vec3(0, 0, 1), 0.8, 4)).find("one end of a limb") != std::string::npos);

    const auto chair = [](const Vec3& x) {
        double d = box_distance(x, {-0.25, -0.25, 0.42}, {0.25, 0.25, 0.5});
        d = std::min(d, box_distance(x, {-0.25, 0.17, 0.42}, {0.25, 0.25, 1.0}));
        for (const double sx : {-0.2, 0.2})
            for (const double sy : {-0.2, 0.2})
                d = std::min(d, box_distance(x, {sx - 0.04, sy - 0.04, 0}, {sx + 0.04, sy + 0.04, 0.45}));
        return d;
    };
    CHECK(refusal(surface_net(chair, {-0.4, -0.4, -0.1}, {0.4, 0.4, 1.1}, {0.02})).find("no hands") !=
          std::string::npos);

    TriangleMesh fallen = mannequin();
    for (Vec3& x : fallen.vertices) x = Vec3(x.x(), -x.y(), 1.7 - x.z());
    CHECK(refusal(fallen).find("body.obj: found no two feet on the ground") == 0);

    TriangleMesh halves = mannequin();
    std::erase_if(halves.faces, [&](const Face& face) { return std::abs(halves.vertices[face[0]].z() - 0.9) < 0.02; });
    CHECK(refusal(halves).find("loose pieces, the largest of which has") != std::string::npos);

    TriangleMesh top = mannequin();
    std::erase_if(top.faces, [&](const Face& face) { return top.vertices[face[0]].z() < 1; });
    CHECK(refusal(top).find("3 ends of limbs") != std::string::npos);
}
