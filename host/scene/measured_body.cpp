#include "host/scene/measured_body.hpp"

#include <filesystem>

#include <fmt/format.h>
#include <Eigen/Geometry>

#include "host/examine/file_mesh.hpp"
#include "host/examine/sizes.hpp"
#include "host/scene/body_model.hpp"
#include "io/mesh/mesh_obj.hpp"
#include "io/number_text.hpp"
#include "io/scene/presets.hpp"
#include "io/scene/read_scene.hpp"

namespace selvage {
namespace {

constexpr double smallest = 0.4, largest = 2.6;  // height of a person, from newborn to tallest [m]

// A body that lies, as a file with another up axis gives it, is flatter than this part of its longest side.
constexpr double lying = 0.45;

constexpr const char* built_in_body = "builtin:mannequin";

void examine_size(const TriangleMesh& mesh, const BodySource& body)
{
    Eigen::AlignedBox3d box;
    for (const Face& face : mesh.faces)
        for (const int v : face) box.extend(mesh.vertices[v]);
    const Vec3 size = box.sizes();
    const InputPlace place{body.source, 0, 0, {}};
    if (size.z() < lying * size.maxCoeff()) {
        std::string others;  // both: with the arms spread a body is as wide as high
        for (const std::string_view axis : words_of<Axis>())
            if (axis != word_of(body.up_axis)) others += fmt::format("{}--up {}", others.empty() ? "" : " or ", axis);
        throw InputError(place,
                         fmt::format("a body that lies: {:.3g} x {:.3g} m seen from above, {:.3g} m high", size.x(),
                                     size.y(), size.z()),
                         fmt::format("a body that stands; {} if that is up in the file", others));
    }
    if (!(size.z() >= smallest && size.z() <= largest))
        throw InputError(place, fmt::format("a body {:.3g} m high", size.z()),
                         fmt::format("{}; --unit or --scale: it would be {}", range_text(smallest, largest, "m"),
                                     sizes_by_unit(size.z(), body.unit)));
}

TriangleMesh body_of_scene(const BodySource& body)
{
    const std::string source = body.source == built_in_body ? "builtin:tshirt" : body.source;
    const Scene scene = read_scene(source, body.overrides);
    if (scene.bodies.empty())
        throw InputError({body.source, 0, 0, {}}, "a scene without bodies", "a scene with a [[body]]");
    std::vector<Finding> findings;
    return build_bodies(scene, findings).front().mesh;
}

TriangleMesh body_of_file(const BodySource& body)
{
    if (!body.overrides.empty())
        throw InputError({body.source, 0, 0, {}}, "--set with a mesh",
                         "--set only with a scene, or with " + std::string(built_in_body));
    ObjMesh obj = read_obj(body.source, body.unit, body.up_axis);
    for (Vec3& x : obj.vertices) x *= body.scale;
    std::vector<Finding> findings;
    const FileMesh cut = cut_polygons(std::move(obj), findings);
    TriangleMesh mesh{cut.obj.vertices, cut.mesh.faces, {}};
    for (Face& face : mesh.faces)
        for (int& v : face) v = cut.vertex_source[v];
    return mesh;
}

}  // namespace

TriangleMesh load_measured_body(const BodySource& body)
{
    const bool is_scene = is_builtin(body.source) || std::filesystem::path(body.source).extension() == ".toml";
    const TriangleMesh mesh = is_scene ? body_of_scene(body) : body_of_file(body);
    examine_size(mesh, body);
    return mesh;
}

}  // namespace selvage
