#include "host/mannequin/mannequin.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "host/mannequin/mannequin_shape.hpp"
#include "host/mesh/surface_net.hpp"
#include "io/errors.hpp"

namespace selvage {
namespace {

struct Bound {
    const char* name;
    double MannequinMeasures::*member;
    double low, high;
};

constexpr std::array<Bound, 8> bounds{{{"stature", &MannequinMeasures::stature, 1.00, 2.10},
                                       {"bust", &MannequinMeasures::bust, 0.55, 1.35},
                                       {"waist", &MannequinMeasures::waist, 0.50, 1.25},
                                       {"hips", &MannequinMeasures::hips, 0.58, 1.40},
                                       {"shoulder_width", &MannequinMeasures::shoulder_width, 0.22, 0.46},
                                       {"neck", &MannequinMeasures::neck, 0.25, 0.48},
                                       {"arm_length", &MannequinMeasures::arm_length, 0.34, 0.78},
                                       {"arm_angle", &MannequinMeasures::arm_angle, 0.0, 80.0}}};

void check(const MannequinMeasures& measures, const InputPlace& body)
{
    for (const Bound& bound : bounds) {
        const double value = measures.*bound.member;
        if (value >= bound.low && value <= bound.high) continue;
        InputPlace place = body;
        place.key += fmt::format(".{}", bound.name);
        const char* unit = bound.member == &MannequinMeasures::arm_angle ? "degrees" : "m";
        throw InputError(place, fmt::format("{}", value),
                         fmt::format("a value from {} to {} {}", bound.low, bound.high, unit));
    }
}

constexpr std::array<const char*, 7> part_names{"head",      "neck",     "torso",    "left_arm",
                                                "right_arm", "left_leg", "right_leg"};

/// Sorts the faces by the body part at their centre and names the resulting ranges.
void name_parts(TriangleMesh& mesh, const MannequinShape& shape)
{
    std::array<std::vector<Face>, part_names.size()> groups;
    for (const Face& face : mesh.faces) {
        const Vec3 centre = (mesh.vertices[face[0]] + mesh.vertices[face[1]] + mesh.vertices[face[2]]) / 3;
        groups[std::size_t(shape.part(centre))].push_back(face);
    }
    mesh.faces.clear();
    for (std::size_t part = 0; part < groups.size(); ++part) {
        mesh.parts.push_back({part_names[part], int(mesh.faces.size()), int(groups[part].size())});
        mesh.faces.insert(mesh.faces.end(), groups[part].begin(), groups[part].end());
    }
}

}  // namespace

TriangleMesh make_mannequin(const MannequinMeasures& measures, const InputPlace& body)
{
    check(measures, body);
    const MannequinShape shape(measures);
    const MannequinLandmarks at = shape.landmarks();
    const double margin = 0.08, hand = 0.22 * measures.stature / 1.70;
    const Vec3 finger = at.wrist[0] + hand * at.arm_direction[0];
    const double side = std::max(finger.x(), 0.5 * measures.hips / 2) + margin;
    SurfaceNetOptions options;
    options.spacing *= std::min(measures.stature / 1.70, 1.0);  // children have thinner hands
    TriangleMesh mesh = surface_net(shape, {-side, at.front - 2 * margin, -0.03},
                                    {side, at.back + margin, measures.stature + 0.03}, options);
    name_parts(mesh, shape);
    return mesh;
}

std::vector<Vec3> mannequin_with_arms(const TriangleMesh& mannequin, const MannequinMeasures& measures,
                                      double arm_angle)
{
    const MannequinShape shape(measures);
    std::vector<Vec3> vertices = mannequin.vertices;
    for (Vec3& x : vertices) x = shape.with_arms_at(arm_angle, x);
    return vertices;
}

MannequinLandmarks mannequin_landmarks(const MannequinMeasures& measures)
{
    check(measures, {"", 0, 0, "body"});
    return MannequinShape(measures).landmarks();
}

}  // namespace selvage
