#include "host/run/run_findings.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string_view>

#include <fmt/format.h>

#include "host/model/cloth_place.hpp"

namespace selvage {
namespace {

struct EndTuning {
    // [1] of its own height by which a garment that is still worn does not fall. Of 24 garments of others and the
    // built-in ones those that hold settle by at most a tenth, most are pulled up as they are sewn; skirts that slid to
    // the hips and the knees had fallen by 0.33 and 0.46.
    static constexpr double worn_fall = 0.2;
    static constexpr double touch = 1.5;  // [gap] cloth that lies on a body is within the gap, swinging or not
    // [1] of the cloth's extent. By `bench motion` sheets that end more than a tenth of their side off have a step that
    // errs by 3.2 % and more; steps of 20 ms err by less where cloth of 20 cm and more swings or meets a body.
    static constexpr double long_step = 0.03;
    static constexpr double coarse_ulp = 0.01;  // [edge length] rounding of positions that can make triangles cross
};

constexpr std::array<std::string_view, 4> crossing_kinds{"self_intersection", "body_intersection", "penetration",
                                                         "stitch"};

bool is_of_crossing(const Finding& finding)
{
    return std::find(crossing_kinds.begin(), crossing_kinds.end(), finding.kind) != crossing_kinds.end();
}

// Why triangles may cross though steps keep them apart.
std::string why_crossed(const ClothModel& model, const EndCrossings& crossings)
{
    double largest = 0;
    for (const Vec3& x : crossings.positions) largest = std::max(largest, x.cwiseAbs().maxCoeff());
    const float at = float(largest);
    const double ulp = double(std::nextafter(at, std::numeric_limits<float>::infinity()) - at);
    if (ulp > EndTuning::coarse_ulp * typical_edge(model.cloth))
        return fmt::format(
            "positions are written in single precision, which is {:.2g} m coarse there: put the scene "
            "near the origin",
            ulp);
    return "cloth that crosses when it starts may pass through itself until it is apart (`selvage check` shows where "
           "it does): start it apart; with contact.self = false nothing keeps it apart";
}

// The middle of a cloth, and its extent, along a direction.
std::array<double, 2> middle_and_extent(const std::vector<Vec3>& positions, const Vec3& along)
{
    double low = std::numeric_limits<double>::infinity(), high = -low, sum = 0;
    for (const Vec3& x : positions) {
        const double at = x.dot(along);
        low = std::min(low, at);
        high = std::max(high, at);
        sum += at;
    }
    return {sum / double(positions.size()), high - low};
}

std::vector<bool> touched_bodies(const Phase& phase, std::size_t count)
{
    std::vector<bool> touches(count);
    const ClothBodyContact* contact = phase.contact();
    if (!contact) return touches;
    const State& state = phase.state();
    const int vs = state.size.vertex_stride;
    const double reach = EndTuning::touch * body_gap(phase.params());
    for (int v = 0; v < state.size.vertex_count; ++v) {
        const int body = contact->body_of_vertex()[std::size_t(v)];
        double distance = -state.contact_offset[v];
        for (int c = 0; c < 3; ++c) distance += state.contact_normal[c * vs + v] * state.pos[c * vs + v];
        if (body >= 0 && distance < reach) touches[std::size_t(body)] = true;
    }
    return touches;
}

}  // namespace

std::int64_t EndCrossings::count_with_bodies() const
{
    std::int64_t count = 0;
    for (const auto& pairs : with_body) count += std::int64_t(pairs.size());
    return count;
}

std::vector<Finding> find_end_crossings(const ClothModel& model, const EndCrossings& crossings)
{
    std::vector<Finding> findings;
    const auto add = [&](const char* kind, const std::vector<IntersectingPair>& pairs, const std::string& text) {
        if (pairs.empty()) return;
        findings.push_back(
            {kind,
             {},
             fmt::format("{}, first {}", text, describe_face(model.cloth, pairs.front()[0], crossings.positions)),
             why_crossed(model, crossings)});
    };
    add("self_intersection", crossings.self,
        fmt::format("{} pairs of the cloth's triangles intersect at the end", crossings.self.size()));
    for (std::size_t b = 0; b < crossings.with_body.size(); ++b)
        add("body_intersection", crossings.with_body[b],
            fmt::format("the cloth intersects the body `{}` at the end, in {} pairs of triangles", model.bodies[b].name,
                        crossings.with_body[b].size()));
    return findings;
}

std::vector<Finding> find_lost_garment(const ClothModel& model, const GarmentFall& fall)
{
    std::string bodies;
    bool touches = false;
    for (std::size_t b = 0; b < model.bodies.size(); ++b) {
        if (model.bodies[b].kind == Body::Kind::plane) continue;
        bodies += (bodies.empty() ? "`" : ", `") + model.bodies[b].name + "`";
        touches = touches || fall.touches[b];
    }
    const bool fell = fall.fall > EndTuning::worn_fall * fall.height;
    if (bodies.empty() || (touches && !fell)) return {};
    std::string text = fell ? fmt::format(
                                  "the garment has slid off or missed its body: it has fallen by {:.2f} m and "
                                  "was {:.2f} m high",
                                  fall.fall, fall.height)
                            : "the garment is not worn";
    if (!touches) text += "; it touches " + bodies + " nowhere";
    return {{"lost_garment",
             {},
             text,
             "place it around the body (garment.translation), or make it narrower where it is to hold (garment.size, "
             "the pattern)"}};
}

std::vector<Finding> find_lost_garment(const ClothModel& model, const Phase& phase, const std::vector<Vec3>& positions)
{
    if (model.cloth.outline.empty()) return {};
    const auto& gravity = phase.params().gravity;
    const Vec3 weight{gravity.acceleration_x, gravity.acceleration_y, gravity.acceleration_z};
    GarmentFall fall{.touches = touched_bodies(phase, model.bodies.size())};
    if (!weight.isZero()) {
        const Vec3 down = weight.normalized();
        const auto [start, height] = middle_and_extent(model.cloth.positions, down);
        fall.height = height;
        fall.fall = middle_and_extent(positions, down)[0] - start;
    }
    return find_lost_garment(model, fall);
}

std::vector<Finding> find_long_steps(const MotionAccuracy& accuracy, const std::vector<Vec3>& positions)
{
    Eigen::AlignedBox3d box;
    for (const Vec3& x : positions) box.extend(x);
    const double part = accuracy.largest_error / box.diagonal().norm();
    if (!(part > EndTuning::long_step)) return {};
    return {
        {"long_steps",
         {},
         fmt::format("steps are long for this motion: the one that ends at {:.4g} s errs by about {:.3g} mm, {:.0f} % "
                     "of the cloth's extent",
                     accuracy.error_time, 1000 * accuracy.largest_error, 100 * part),
         "a shorter solver.step, or solver.adaptive = true"}};
}

std::vector<Finding> findings_that_mattered(const std::vector<Finding>& before, bool complete,
                                            const std::vector<Finding>& at_end)
{
    const bool crossed = std::any_of(at_end.begin(), at_end.end(), is_of_crossing);
    std::vector<Finding> mattered;
    for (const Finding& finding : before)
        if (finding.severity != Severity::note && (!complete || (crossed && is_of_crossing(finding))))
            mattered.push_back(finding);
    return mattered;
}

}  // namespace selvage
