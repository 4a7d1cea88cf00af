#include "host/examine/cloth_place.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include <fmt/format.h>
#include <Eigen/Geometry>

namespace selvage {
namespace {

struct PlaceLimits {
    static constexpr double smallest = 0.02, largest = 20;  // of a garment or sheet [m]
    static constexpr double beside = 0.5;                   // of its size: cloth may swing so far aside as it falls
    static constexpr double unsafe = 0.25;                  // of the contact gap: positions coarser than that cross
};

// A garment or a sheet: what falls as one.
struct Thing {
    std::string name;  ///< For messages.
    std::string key;   ///< That moves it.
    Box box;
    bool held = false;   ///< A vertex of it is pinned.
    bool sized = false;  ///< Its file has been examined for its size.
};

std::vector<Thing> things_of(const Cloth& cloth, const Scene& scene)
{
    std::vector<char> held(cloth.positions.size());
    for (const int v : cloth.pinned) held[v] = 1;
    const int sheets = int(scene.sheets.size()), of_garments = int(cloth.panels.size()) - sheets;
    const int copies = scene.has_garment() ? scene.garment.copies : 0;
    std::vector<Thing> things;
    for (int c = 0; c < copies; ++c) things.push_back({"the garment", "garment.translation", {}});
    for (int i = 0; i < sheets; ++i)
        things.push_back({fmt::format("sheet[{}]", i),
                          fmt::format("sheet[{}].center", i),
                          {},
                          false,
                          scene.sheets[i].shape == SheetShape::mesh});
    for (int p = 0; p < int(cloth.panels.size()); ++p) {
        Thing& thing = things[p < of_garments ? p / (of_garments / copies) : copies + p - of_garments];
        const int first = cloth.panels[p].first_vertex;
        for (int v = first; v < first + cloth.panels[p].vertex_count; ++v) {
            thing.box.extend(cloth.positions[v]);
            thing.held = thing.held || held[v];
        }
    }
    return things;
}

void find_odd_sizes(const std::vector<Thing>& things, std::vector<Finding>& findings)
{
    for (const Thing& thing : things) {
        const double size = thing.box.diagonal().norm();
        if (!thing.sized && (size > PlaceLimits::largest || size < PlaceLimits::smallest))
            findings.push_back(
                {"unit", {}, fmt::format("{} is {:.3g} m across: is its unit right?", thing.name, size)});
    }
}

// Files, pictures and trees hold positions in single precision.
void find_far_out(const std::vector<Thing>& things, const Scene& scene, std::vector<Finding>& findings)
{
    const double promised = scene.output.precision == PositionGrid::coarse_60um ? 60e-6 : 8e-6;
    for (const Thing& thing : things) {
        const double far = std::max(thing.box.min().cwiseAbs().maxCoeff(), thing.box.max().cwiseAbs().maxCoeff());
        const double apart =
            double(std::nextafter(float(far), std::numeric_limits<float>::infinity())) - double(float(far));
        if (apart <= promised) continue;
        findings.push_back(
            {"far",
             {},
             fmt::format("{} lies up to {:.3g} m from the origin, where positions in single precision are "
                         "{:.2g} mm apart",
                         thing.name, far, 1000 * apart),
             "move the whole scene to the origin",
             apart > PlaceLimits::unsafe * scene.contact.gap ? Severity::fault : Severity::warning});
        return;
    }
}

// The space that a box takes as it falls.
Box swept(const Box& box, const Vec3& way)
{
    Box result = box;
    result.extend(Vec3(box.min() + way));
    result.extend(Vec3(box.max() + way));
    const Vec3 aside = Vec3::Constant(PlaceLimits::beside * box.diagonal().norm());
    return {result.min() - aside, result.max() + aside};
}

std::string where_it_lies(const Thing& thing, const Box& body, const Vec3& down)
{
    const Vec3 way = thing.box.center() - body.center();
    const double below = way.dot(down), half = 0.5 * body.sizes().cwiseProduct(down.cwiseAbs()).sum();
    return below > half ? "below it" : below < -half ? "above it, off to a side" : "beside it";
}

void find_fallen(const std::vector<Thing>& things, const std::vector<Body>& bodies, const Scene& scene,
                 std::vector<Finding>& findings)
{
    const Vec3& gravity = scene.solver.gravity;
    const auto caught_anyway = [](const Body& body) { return body.kind == Body::Kind::plane || body.motion; };
    if (bodies.empty() || !scene.contact.body || gravity.isZero() || std::ranges::any_of(bodies, caught_anyway)) return;
    std::vector<Box> boxes;
    Box all;
    for (const Body& body : bodies) all.extend(boxes.emplace_back(box_of(body.mesh.vertices)));
    for (const Thing& thing : things) all.extend(thing.box);
    const Vec3 down = gravity.normalized(), way = all.diagonal().norm() * down;
    std::vector<char> stays(things.size());
    for (std::size_t round = 0; round < things.size(); ++round)
        for (std::size_t t = 0; t < things.size(); ++t) {
            const Box path = swept(things[t].box, way);
            stays[t] =
                things[t].held || std::ranges::any_of(boxes, [&](const Box& body) { return path.intersects(body); });
            for (std::size_t other = 0; other < things.size(); ++other)
                stays[t] = stays[t] || (other != t && stays[other] && path.intersects(things[other].box));
        }
    for (std::size_t t = 0; t < things.size(); ++t) {
        if (stays[t]) continue;
        const auto nearest = std::ranges::min_element(
            boxes, {}, [&](const Box& body) { return body.squaredExteriorDistance(things[t].box); });
        findings.push_back(
            {"away",
             {},
             fmt::format("{} lies {:.3g} m from the nearest body, `{}`, {}: it falls past all bodies", things[t].name,
                         std::sqrt(nearest->squaredExteriorDistance(things[t].box)),
                         bodies[std::size_t(nearest - boxes.begin())].name, where_it_lies(things[t], *nearest, down)),
             fmt::format("{} moves it", things[t].key)});
    }
}

}  // namespace

std::vector<Finding> examine_place(const ClothModel& model, const Scene& scene)
{
    const std::vector<Thing> things = things_of(model.cloth, scene);
    std::vector<Finding> findings;
    find_odd_sizes(things, findings);
    find_far_out(things, scene, findings);
    find_fallen(things, model.bodies, scene, findings);
    return findings;
}

}  // namespace selvage
