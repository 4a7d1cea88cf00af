#include "host/run/failure_report.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "host/mesh/closest_on_triangle.hpp"
#include "host/model/cloth_place.hpp"
#include "host/run/measure.hpp"
#include "host/solver/state/planes.hpp"

namespace selvage {
namespace {

// Where one cause is taken for likelier than another; by hand, on the tests of messages.
struct ReportTuning {
    static constexpr double near = 5;           // [gap] bodies that are this near take part
    static constexpr double torn = 0.2;         // [1] stretch that cloth does not see in wear
    static constexpr double moving = 0.02;      // [m/s] slower is creeping
    static constexpr double nearly = 10;        // [asked residual] cloth that is nearly at rest
    static constexpr double gathered = 1.3;     // [1] ratio of a seam's sides from which on gathering is an effort
    static constexpr double speed_time = 1e-3;  // [s] over which a body's speed is taken
};

std::string millimetres(double metres) { return fmt::format("{:.3g} mm", 1000 * metres); }

std::string sentence(const std::string& first, const std::string& second)
{
    return first + (first.empty() || second.empty() ? "" : "; ") + second;
}

std::vector<BodyAt> those_near(const std::vector<BodyAt>& bodies, double gap)
{
    std::vector<BodyAt> near;
    for (const BodyAt& body : bodies)
        if (body.distance < ReportTuning::near * gap) near.push_back(body);
    return near;
}

std::string distances(const std::vector<BodyAt>& bodies)
{
    std::vector<std::string> texts;
    for (const BodyAt& body : bodies) texts.push_back(millimetres(body.distance) + " from `" + body.name + "`");
    return fmt::format("{}", fmt::join(texts, ", "));
}

const BodyAt* fastest_of(const std::vector<BodyAt>& bodies)
{
    const auto fastest = std::max_element(bodies.begin(), bodies.end(),
                                          [](const BodyAt& a, const BodyAt& b) { return a.speed < b.speed; });
    return fastest == bodies.end() || fastest->speed == 0 ? nullptr : &*fastest;
}

constexpr const char* shorter_step = "a shorter solver.step";

void explain_torn(const DivergenceFacts& facts, FailureReport& report)
{
    const BodyAt* moving = fastest_of(facts.bodies);
    report.cause = fmt::format("the cloth is torn: {} is stretched by {:.0f} %", facts.stretched, 100 * facts.stretch);
    if (moving)
        report.cause += fmt::format(", the body `{}` moves at {:.3g} m/s with friction {:.3g}", moving->name,
                                    moving->speed, moving->friction);
    if (facts.holds) report.cause += ", and vertices are held";
    report.cure = sentence(moving ? "less friction (body.friction) or a slower body (body.keyframe)" : "",
                           facts.holds ? "other held vertices ([pins], [[pins.motion]])" : "");
    if (report.cure.empty()) report.cure = "a stiffer fabric (stretch_weft, stretch_warp)";
}

// What pushes cloth out of bodies and out of itself then pushes against each other.
void explain_caught(const DivergenceFacts& facts, FailureReport& report)
{
    report.cause = fmt::format(
        "cloth is inside a body or crosses itself or a body, in {} vertices or pairs of triangles", facts.crossings);
    report.cure = "start the cloth outside the bodies and uncrossed (`selvage check` shows where it is not)";
}

// Whether cloth is between two bodies of which one moves.
bool explain_closing(const DivergenceFacts& facts, FailureReport& report)
{
    const std::vector<BodyAt> near = those_near(facts.bodies, facts.gap);
    const BodyAt* moving = fastest_of(near);
    if (near.size() < 2 || !moving) return false;
    const BodyAt& other = near[moving == &near[0] ? 1 : 0];
    report.cause = fmt::format("the bodies `{}` and `{}` close on the cloth between them", moving->name, other.name);
    report.cure = fmt::format(
        "leave at least {} between them, twice contact.gap, in their keyframes or sequence, or "
        "lower contact.gap",
        millimetres(2 * facts.gap));
    return true;
}

// Newton's method does not come to an end.
void explain_unsolved(const DivergenceFacts& facts, FailureReport& report)
{
    const BodyAt* moving = fastest_of(facts.bodies);
    if (explain_closing(facts, report)) return;
    if (facts.crossings > 0) return explain_caught(facts, report);
    if (facts.stretch > ReportTuning::torn) return explain_torn(facts, report);
    if (moving && moving->speed * facts.step.longest > facts.gap)
        report.cause = fmt::format("the body `{}` moves at {:.3g} m/s, {} in a step", moving->name, moving->speed,
                                   millimetres(moving->speed * facts.step.longest));
    else
        report.cause = "Newton's method does not solve the step";
    report.cure = std::string(shorter_step) + ", more solver.newton_iterations or solver.linear_iterations, " +
                  "solver.precision = double";
}

// Bodies or held vertices that cannot get to where they are to be.
void explain_block(const DivergenceFacts& facts, FailureReport& report)
{
    std::vector<std::string> held;
    for (const VertexAt& vertex : facts.vertices)
        if (vertex.held) held.push_back(vertex.name);
    const std::string& pushing = facts.step.obstacle_body;
    if (explain_closing(facts, report)) return;
    if (facts.pins_move && held.size() >= 2) {
        report.cause = fmt::format("held vertices are driven against each other: {} and {}", held.front(), held.back());
        report.cure =
            fmt::format("end their [[pins.motion]] before {:.3g} s, or lead them past each other", facts.time);
    } else if (facts.stretch > ReportTuning::torn) {
        explain_torn(facts, report);
    } else if (!pushing.empty() && !held.empty()) {
        report.cause = fmt::format("the body `{}` is driven into cloth that is held: {}", pushing, held.front());
        report.cure = "let the held vertices go along ([[pins.motion]]), hold others, or lead the body elsewhere";
    } else if (!pushing.empty()) {
        report.cause = fmt::format("the body `{}` is driven into cloth that cannot make way", pushing);
        report.cure = "move the body more slowly or leave the cloth more room (body.keyframe), or take " +
                      std::string(shorter_step);
    } else if (const BodyAt* carrying = fastest_of(facts.bodies); carrying && !facts.pins_move) {
        report.cause = fmt::format("the body `{}` moves at {:.3g} m/s and carries cloth along that cannot make way",
                                   carrying->name, carrying->speed);
        report.cure = "move the body more slowly (body.keyframe), less friction, or " + std::string(shorter_step);
    } else {
        report.cause = "held vertices are driven into cloth that cannot make way";
        report.cure = "change their [[pins.motion]], or take " + std::string(shorter_step);
    }
}

void explain_cause(const DivergenceFacts& facts, FailureReport& report)
{
    const std::string scheme = "an implicit solver.integrator (implicit_euler, bdf2)";
    switch (facts.step.fault) {
        case StepFault::blocked:
            return explain_block(facts, report);
        case StepFault::stuck:
        case StepFault::unsolved:
            return explain_unsolved(facts, report);
        case StepFault::not_finite:
            report.cause = "a step leads to positions or forces that are no numbers";
            report.cure =
                std::string(shorter_step) + ", solver.precision = double, or a fabric less stiff or less light";
            return;
        case StepFault::passed:
            report.cause = "the cloth would pass through itself or through a body";
            break;
        case StepFault::entered_body:
            report.cause = "cloth would pass into a body";
            break;
        case StepFault::gained_energy:
            report.cause = "the steps make energy from nothing";
            break;
        case StepFault::unstable:
            report.cause = "the cloth has become so stiff or so fast that no step is stable";
            break;
    }
    report.cure = shorter_step;
    if (facts.is_explicit) report.cure += " or " + scheme;
}

}  // namespace

std::string describe(const FailureReport& report)
{
    std::string text = report.what;
    const auto add = [&](const char* head, const std::string& line) {
        if (!line.empty()) text += std::string("\n  ") + head + ": " + line;
    };
    add("where", report.where);
    add("likely cause", report.cause);
    add("what to do", report.cure);
    return text;
}

FailureReport explain(const DivergenceFacts& facts)
{
    FailureReport report;
    report.what =
        fmt::format("diverged at {:.4g} s ({}): {}", facts.time, facts.stage, StepFailureError(facts.step).what());
    std::vector<std::string> names;
    for (const VertexAt& vertex : facts.vertices) names.push_back(vertex.name + (vertex.held ? ", held" : ""));
    report.where = sentence(fmt::format("{}", fmt::join(names, "; ")), distances(those_near(facts.bodies, facts.gap)));
    explain_cause(facts, report);
    return report;
}

FailureReport explain(const UnrestFacts& facts)
{
    FailureReport report;
    report.what = fmt::format(
        "not at rest after {:.1f} s (solver.max_time): relative force residual {:.2e}, asked "
        "{:.2e}",
        facts.time, facts.residual, facts.asked);
    report.where = sentence(fmt::format("most force is left on {}, {:.2g} N; {} moves most, at {:.2g} m/s",
                                        facts.pulled, facts.net_force, facts.fastest, facts.speed),
                            distances(those_near(facts.bodies, facts.gap)));
    if (facts.crossings > 0) {
        report.cause = fmt::format(
            "{} pairs of triangles still intersect or vertices are inside a body, as they did "
            "at the start",
            facts.crossings);
        report.cure = "start the cloth apart: `selvage check` shows where it crosses";
    } else if (facts.speed > ReportTuning::moving) {
        report.cause = "the cloth still moves";
        report.cure = "more solver.max_time, or more damping of the fabric";
    } else if (facts.residual < ReportTuning::nearly * facts.asked) {
        report.cause = "the cloth is nearly at rest, and the last forces fall slowly";
        report.cure = fmt::format("more solver.max_time, or solver.tolerance = {:.1g}", 1.5 * facts.residual);
    } else {
        report.cause = "forces that do not move the cloth do not balance either: it is jammed, or caught in a fold";
        report.cure = std::string(shorter_step) + ", solver.precision = double, another solver.integrator";
    }
    return report;
}

FailureReport explain(const OpenSeamFacts& facts)
{
    FailureReport report;
    report.what = fmt::format("the seam of {} and {} is still open by {:.1f} mm after {:.1f} s (seams.max_time)",
                              facts.sides[0], facts.sides[1], 1000 * facts.gap, facts.time);
    if (!facts.place.empty()) report.what = facts.place + ": " + report.what;
    for (const OpenSeamFacts::Other& other : facts.others)
        report.what += fmt::format("; that of {} and {} by {:.1f} mm ({})", other.sides[0], other.sides[1],
                                   1000 * other.gap, other.place);
    const bool body_between = !facts.bodies.empty() && facts.bodies.front().distance < 0.5 * facts.gap;
    report.where =
        sentence(facts.ends[0] + " and " + facts.ends[1], body_between ? distances({facts.bodies.front()}) : "");
    const double shorter = std::min(facts.lengths[0], facts.lengths[1]);
    const double longer = std::max(facts.lengths[0], facts.lengths[1]);
    if (longer > ReportTuning::gathered * shorter) {
        report.cause = fmt::format("its sides are {:.3g} m and {:.3g} m long, and the longer one has to be gathered",
                                   facts.lengths[0], facts.lengths[1]);
        report.cure = "lengths that match better, a finer garment.resolution, or more seams.max_time";
    } else if (body_between) {
        report.cause = "the body `" + facts.bodies.front().name + "` stands between the two sides";
        report.cure = "panels placed around the body (panel translations, garment.translation), or a larger garment";
    } else {
        report.cause = "the seam is pulled too weakly for the fabric, or cloth is in its way";
        report.cure = "more seams.stiffness or seams.max_time, or panels that start nearer to each other";
    }
    return report;
}

// Facts ----------------------------------------------

namespace {

// Distance of a point from a surface, of a plane beyond its drawn part too [m].
double distance_to(const Body& body, const TriangleMesh& mesh, const Vec3& x)
{
    double least = std::numeric_limits<double>::infinity();
    for (const Face& f : mesh.faces) {
        const Vec3 &a = mesh.vertices[f[0]], &b = mesh.vertices[f[1]], &c = mesh.vertices[f[2]];
        const Vec3 normal = (b - a).cross(c - a);
        if (normal.isZero(0)) continue;
        if (body.kind == Body::Kind::plane) return std::abs(normal.normalized().dot(x - a));
        least = std::min(least, closest_on_triangle(x, a, b, c).squared_distance);
    }
    return std::sqrt(least);
}

std::vector<BodyAt> bodies_seen_from(const ClothModel& model, double time, const Vec3& x)
{
    double of_fabric = 0;
    for (const auto& [name, fabric] : model.fabrics) of_fabric = std::max(of_fabric, fabric.friction);
    std::vector<BodyAt> bodies;
    for (const Body& body : model.bodies) {
        const TriangleMesh mesh = body_mesh_at(body, time);
        BodyAt at{.name = body.name, .friction = std::isnan(body.friction) ? of_fabric : body.friction};
        at.distance = distance_to(body, mesh, x);
        if (body.motion) {
            const TriangleMesh later = body_mesh_at(body, time + ReportTuning::speed_time);
            for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
                at.speed = std::max(at.speed, (later.vertices[v] - mesh.vertices[v]).norm() / ReportTuning::speed_time);
        }
        bodies.push_back(at);
    }
    std::stable_sort(bodies.begin(), bodies.end(),
                     [](const BodyAt& a, const BodyAt& b) { return a.distance < b.distance; });
    return bodies;
}

Vec3 position_of(const State& state, int particle) { return vertex_planes(state.size, state.pos)(particle); }

VertexAt vertex_at(const ClothModel& model, const Phase& phase, int particle)
{
    const std::vector<int>& particle_of = phase.topology().particle_of;
    const auto vertex = std::find(particle_of.begin(), particle_of.end(), particle);
    return {describe_vertex(model.cloth, int(vertex - particle_of.begin()), position_of(phase.state(), particle)),
            phase.state().inv_mass[std::size_t(particle)] == 0};
}

// Of one side of a pair, a held corner before others; -1: it is one of a body.
int telling_corner(const State& state, std::span<const int> side)
{
    for (int v : side)
        if (v >= 0 && state.inv_mass[std::size_t(v)] == 0) return v;
    return std::max(side.front(), -1);
}

// The vertex with the longest vector.
int largest_at(const State& state, const std::vector<real>& field)
{
    const ConstPlanes planes = vertex_planes(state.size, field);
    int at = 0;
    for (int v = 1; v < state.size.vertex_count; ++v)
        if (planes(v).squaredNorm() > planes(at).squaredNorm()) at = v;
    return at;
}

// Pairs of triangles that intersect, and vertices inside bodies, where contact of cloth looks for them.
int crossings_of(const Phase& phase)
{
    if (!phase.cloth_contact()) return 0;
    const ClothContactCounts counts = phase.cloth_contact()->counts();
    return counts.tangles + counts.inside;
}

}  // namespace

DivergenceFacts divergence_facts(const SceneModel& model, const Phase& phase, const std::string& stage,
                                 const StepFailure& failure, const IntegratorInfo& integrator)
{
    const ClothModel& cloth = model.cloth_model;
    const State& state = phase.state();
    DivergenceFacts facts{.stage = stage, .time = phase.system().clock().time, .step = failure};
    Vec3 at = failure.obstacle_point;
    if (failure.obstacle) {
        const auto& corner = failure.obstacle->corner;
        const int first = failure.obstacle->edges ? 2 : 1;
        for (const std::span<const int> side : {std::span(corner).first(first), std::span(corner).subspan(first)})
            if (const int v = telling_corner(state, side); v >= 0) facts.vertices.push_back(vertex_at(cloth, phase, v));
    } else if (failure.particle >= 0) {
        facts.vertices.push_back(vertex_at(cloth, phase, failure.particle));
        at = position_of(state, failure.particle);
    }
    if (!facts.vertices.empty()) facts.bodies = bodies_seen_from(cloth, facts.time, at);
    facts.gap = body_gap(phase.params());
    const std::vector<Vec3> positions = phase.positions();
    const FaceStretch largest = largest_stretch(cloth.cloth, positions, 0);
    facts.stretch = largest.stretch;
    if (largest.face >= 0) facts.stretched = describe_face(cloth.cloth, largest.face, positions);
    facts.holds = !cloth.cloth.pinned.empty();
    facts.pins_move = !cloth.cloth.pin_motions.empty();
    facts.is_explicit = integrator.is_explicit;
    facts.crossings = crossings_of(phase);
    return facts;
}

UnrestFacts unrest_facts(const SceneModel& model, const Phase& phase, double residual, double asked)
{
    const State& state = phase.state();
    UnrestFacts facts{.time = phase.system().clock().time, .residual = residual, .asked = asked};
    const std::vector<real> force = phase.system().static_force();
    const int pulled = largest_at(state, force), fastest = largest_at(state, state.vel);
    facts.pulled = vertex_at(model.cloth_model, phase, pulled).name;
    facts.net_force = vertex_planes(state.size, force)(pulled).norm();
    facts.fastest = vertex_at(model.cloth_model, phase, fastest).name;
    facts.speed = vertex_planes(state.size, state.vel)(fastest).norm();
    facts.bodies = bodies_seen_from(model.cloth_model, facts.time, position_of(state, pulled));
    facts.gap = body_gap(phase.params());
    facts.crossings = crossings_of(phase);
    return facts;
}

OpenSeamFacts open_seam_facts(const SceneModel& model, const Phase& phase, double time)
{
    const Cloth& cloth = model.cloth_model.cloth;
    const std::vector<Vec3> positions = phase.positions();
    const std::vector<OpenSeam> open = open_seams(cloth, positions);
    OpenSeamFacts facts;
    facts.time = time;
    if (open.empty()) return facts;
    const Seam& seam = cloth.seams[open.front().seam];
    const std::array<std::string, 2> sides = seam_sides(cloth, open.front().seam);
    std::copy(sides.begin(), sides.end(), facts.sides);
    facts.lengths[0] = seam.length_a;
    facts.lengths[1] = seam.length_b;
    facts.gap = open.front().gap;
    facts.place = describe(seam.place);
    for (std::size_t k = 1; k < open.size(); ++k)
        facts.others.push_back(
            {seam_sides(cloth, open[k].seam), open[k].gap, describe(cloth.seams[open[k].seam].place)});
    const std::array<int, 2>& pair = cloth.seam_pairs[open.front().pair];
    for (int k = 0; k < 2; ++k) facts.ends[k] = describe_vertex(cloth, pair[k], positions[pair[k]]);
    facts.bodies = bodies_seen_from(model.cloth_model, 0, 0.5 * (positions[pair[0]] + positions[pair[1]]));
    return facts;
}

}  // namespace selvage
