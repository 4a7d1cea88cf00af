#include "bench/suites/skip_cases.hpp"

#include <array>
#include <functional>

#include <fmt/format.h>

#include "io/atomic_file.hpp"
#include "io/mesh/mesh_obj.hpp"

namespace selvage {
namespace {

/// The parts of a scene that features change.
struct SceneParts {
    std::string fabric, bodies, tables, output, solver, contact = "self = false", weft = "stretch_weft = 1000";
    double damping = 0;      // [1/s]; always written, because the default of a fabric is not zero
    bool in_places = false;  // take the scene in which most of the cloth is at rest
};

std::string scene_text(const SceneParts& parts, int resolution, double until)
{
    return fmt::format(R"([[sheet]]
width = 0.5
height = 0.5
resolution = {}
fabric = "plain"
center = [0, 0, 1]
[fabric.plain]
source = "a plain test material"
areal_density = 0.2
thickness = 0.0004
{}
stretch_warp = 1000
shear = 100
bending_weft = 1e-5
bending_warp = 1e-5
damping = {}
{}
{}
{}
[contact]
{}
[pins]
sheet = "top_corners"
[solver]
until = {}
{}
[output]
{})",
                       resolution, parts.weft, parts.damping, parts.fabric, parts.bodies, parts.tables, parts.contact,
                       until, parts.solver, parts.output);
}

// A scene in which most of the cloth is at rest: a small sheet falls on a ball beside a large sheet that lies on the
// floor, until equilibrium. The integrator is fixed, so that runs with and without sleep take the same steps.
std::string resting_scene(const SceneParts& parts, int resolution)
{
    return fmt::format(R"([[sheet]]
width = 1.2
height = 1.2
resolution = {}
fabric = "cotton"
center = [-0.9, 0, 0.0012]
[[sheet]]
width = 0.4
height = 0.4
resolution = {}
fabric = "cotton"
center = [0.3, 0, 0.33]
[[body]]
name = "floor"
shape = "plane"
[[body]]
name = "ball"
shape = "sphere"
radius = 0.15
center = [0.3, 0, 0.16]
[solver]
until = "equilibrium"
integrator = "implicit_euler"
{}
[output]
{})",
                       resolution, resolution / 3, parts.solver, parts.output);
}

constexpr const char* quiet_output = "picture = false\nframes = false\n";

// Writes an octahedron of radius 0.1 m, a body whose distance queries need the ray tracing library.
std::string write_octahedron(const std::string& folder)
{
    const std::vector<Vec3> vertices = {{0.1, 0, 0},  {-0.1, 0, 0}, {0, 0.1, 0},
                                        {0, -0.1, 0}, {0, 0, 0.1},  {0, 0, -0.1}};
    const std::vector<Face> faces = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4},
                                     {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
    const std::string path = folder + "/octahedron.obj";
    const std::array objects{ObjObject{"octahedron", vertices, faces}};
    write_obj(path, objects);
    return path;
}

// A body under the sheet, which swings down from its edge at y = 0.25 m. A near body is hit; one 50 m below is not.
std::string body(const std::string& shape, bool near, double friction)
{
    return fmt::format("[[body]]\n{}\ncenter = [0, 0, {}]\nfriction = {}\n", shape, near ? 0.85 : -50.0, friction);
}

using Change = std::function<void(SceneParts&)>;

struct Feature {
    std::string name;
    Change absent, idle, active;  // idle is empty where the scene would be refused: keys that can do nothing are
    std::string trace;            // the phase that a profile has, before the end of the run, if the feature is in use
};

std::vector<Feature> features(const std::string& folder)
{
    const Change nothing = [](SceneParts&) {};
    const std::string ball = "shape = \"sphere\"\nradius = 0.1";
    const std::string mesh = fmt::format("shape = \"mesh\"\nmesh = \"{}\"", write_octahedron(folder));
    const auto with_body = [](const std::string& text) { return [text](SceneParts& parts) { parts.bodies = text; }; };
    const std::string curve = "stretch_weft_curve = [[0.02, 20.0], [0.1, 140.0]]\n";
    const std::string loop = "hysteresis_weft = 2e-4\nhysteresis_warp = 2e-4\n";
    return {
        {"body", nothing, with_body(body(ball, false, 0)), with_body(body(ball, true, 0)), "body_query"},
        {"friction", with_body(body(ball, true, 0)), with_body(body(ball, false, 0.3)),
         with_body(body(ball, true, 0.3)), "friction"},
        {"embree", with_body(body(ball, true, 0)), with_body(body(mesh, false, 0)), with_body(body(mesh, true, 0)),
         "embree"},
        {"damping", nothing, {}, [](SceneParts& parts) { parts.damping = 1; }, "damping"},
        {"hysteresis",
         nothing,
         {},
         [loop](SceneParts& parts) {
             parts.fabric = loop;
             parts.tables = "[bending]\nhysteresis = true\n";
         },
         "bending_hysteresis"},
        {"curves", nothing, {}, [curve](SceneParts& parts) { parts.weft = curve; }, "curved_membrane"},
        {"wind", nothing, {}, [](SceneParts& parts) { parts.tables = "[wind]\nvelocity = [1, 0, 0]\n"; }, "wind"},
        {"self-contact", nothing, [](SceneParts& parts) { parts.contact = "self = true"; }, {}, "cloth_contact_pairs"},
        {"sleep",
         [](SceneParts& parts) {
             parts.in_places = true;
             parts.solver = "sleep = false";
         },
         {},
         [](SceneParts& parts) { parts.in_places = true; },
         "fall_asleep"},
        {"frames", nothing, {}, [](SceneParts& parts) { parts.output = "picture = false\n"; }, "write_frame"},
        {"picture",
         nothing,
         {},
         [](SceneParts& parts) { parts.output = "frames = false\npicture_width = 800\n"; },
         "opencv"},
    };
}

}  // namespace

std::vector<SkipCase> skip_cases(int resolution, double until, const std::string& folder)
{
    std::vector<SkipCase> cases;
    for (const Feature& feature : features(folder)) {
        const std::pair<const char*, const Change&> states[] = {
            {"absent", feature.absent}, {"idle", feature.idle}, {"active", feature.active}};
        for (const auto& [state, change] : states) {
            if (!change) continue;
            SceneParts parts;
            parts.output = quiet_output;
            change(parts);
            const std::string path = folder + "/" + feature.name + "_" + state + ".toml";
            write_file_atomically(
                path, parts.in_places ? resting_scene(parts, resolution) : scene_text(parts, resolution, until));
            cases.push_back({feature.name, state, path, feature.trace});
        }
    }
    return cases;
}

}  // namespace selvage
