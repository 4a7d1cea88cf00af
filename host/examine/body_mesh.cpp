#include "host/examine/body_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <Eigen/Geometry>

#include "host/examine/body_pieces.hpp"
#include "host/examine/close_holes.hpp"
#include "host/examine/mesh_edges.hpp"
#include "host/examine/sizes.hpp"
#include "host/examine/weld.hpp"
#include "host/mesh/body_tessellation.hpp"
#include "io/number_text.hpp"

namespace selvage {
namespace {

struct BodyLimits {
    static constexpr double smallest = 0.02, largest = 20;             // [m]; cloth meets nothing else sensibly
    static constexpr double usual_smallest = 0.05, usual_largest = 5;  // [m]; outside, another unit is more likely
    static constexpr std::size_t holes_named = 3;
};

constexpr const char* outward = "all faces counter-clockwise seen from outside";

// Joins vertices as the scene asks and leaves out those that others now stand for.
void weld(const Scene& scene, int index, FileMesh& body, std::vector<Finding>& findings)
{
    const InputPlace place = scene.place(fmt::format("body[{}].weld", index));
    const WeldRule rule = weld_rule(scene.bodies[index].weld, false, place);
    if (!rule.any) return;
    const int before = int(body.mesh.vertices.size());
    JoinedSets sets{std::size_t(before)};
    join_near(body, rule.distance, place, sets);
    std::vector<int> now(before);
    int kept = 0;
    for (int v = 0; v < before; ++v) {
        if (sets.root(v) != v) continue;
        now[v] = kept;
        body.mesh.vertices[kept] = body.mesh.vertices[v];
        body.vertex_source[kept++] = body.vertex_source[v];
    }
    for (Face& face : body.mesh.faces)
        for (int& v : face) v = now[sets.root(v)];
    body.mesh.vertices.resize(kept);
    body.vertex_source.resize(kept);
    findings.push_back({"weld",
                        {body.file(), 0, 0, {}},
                        fmt::format("{} joined to others", counted(before - kept, "vertex is", "vertices are")),
                        {},
                        Severity::note});
}

void close_holes(const Scene& scene, int index, FileMesh& body, std::vector<Finding>& findings)
{
    const BodyScene& given = scene.bodies[index];
    if (given.close_holes == 0) return;
    const std::size_t before = body.mesh.faces.size();
    int closed = 0;
    double longest = 0;
    for (const Hole& hole : find_holes(body.mesh.vertices, rim_sides(sorted_sides(body.mesh.faces)))) {
        if (hole.length > given.close_holes || !close_hole(hole, body)) continue;
        ++closed;
        longest = std::max(longest, hole.length);
    }
    double added = 0;
    for (std::size_t f = before; f < body.mesh.faces.size(); ++f)
        added += area_of(body.mesh.vertices, body.mesh.faces[f]);
    const InputPlace place = scene.place(fmt::format("body[{}].close_holes", index));
    if (closed == 0)
        findings.push_back({"holes", place, "no hole of the body has a rim that short", {}, Severity::note});
    else
        findings.push_back(
            {"holes",
             place,
             fmt::format("{} of {} closed with {} of {:.3g} m^2 in all, the longest rim {:.3g} m",
                         counted(closed, "hole", "holes"), body.file(),
                         counted(int(body.mesh.faces.size() - before), "triangle", "triangles"), added, longest),
             {},
             Severity::note});
}

// Says how holes can be closed: by joining vertices where that is their cause, else by triangles over them.
std::string way_to_close(const FileMesh& body, const std::vector<FaceSide>& rim, const std::vector<Hole>& holes,
                         const std::string& key)
{
    const std::vector<int> first = first_coincident_vertex(body.mesh.vertices);
    long long doubled = 0;
    for (int v = 0; v < int(first.size()); ++v) doubled += first[v] != v;
    if (doubled > 0)
        return fmt::format("{} on others: {}.weld = \"exact\" joins them",
                           counted(doubled, "vertex lies", "vertices lie"), key);
    if (const std::vector<VertexOnEdge> on_edges = vertices_on_rims(body.mesh.vertices, rim); !on_edges.empty())
        return fmt::format(
            "vertex {} (line {}) lies on the edge from vertex {} to {} without being a corner of the face "
            "there: make it one",
            body.number(on_edges[0].vertex), body.line_of(on_edges[0].vertex), body.number(on_edges[0].from),
            body.number(on_edges[0].to));
    if (holes.empty()) return "every edge with two faces";
    const double scale = std::pow(10, 1 - std::floor(std::log10(holes.front().length)));
    return fmt::format("{}.close_holes = {:.6g} closes all of them with triangles from rim to rim", key,
                       (std::floor(holes.front().length * scale) + 1) / scale);
}

void refuse_holes(const FileMesh& body, const std::vector<FaceSide>& sides, const std::string& key)
{
    const std::vector<FaceSide> rim = rim_sides(sides);
    if (rim.empty()) return;
    const std::vector<Hole> holes = find_holes(body.mesh.vertices, rim);
    std::string named;
    for (std::size_t h = 0; h < std::min(holes.size(), BodyLimits::holes_named); ++h)
        named += fmt::format("{} rim of {:.3g} m{} (vertex {})", h ? "," : ":", holes[h].length,
                             at_text(holes[h].middle), body.number(holes[h].rim.front()));
    const int pieces = pieces_by_edges(sides, body.mesh.faces.size()).count();
    throw InputError(body.at_face(rim.front().face),
                     fmt::format("a body with {} in {}{}{}; the first open edge is from vertex {} to {}",
                                 counted(int(std::max(holes.size(), std::size_t(1))), "hole", "holes"),
                                 counted(pieces, "piece", "pieces"), named,
                                 holes.size() > BodyLimits::holes_named ? " and so on" : "",
                                 body.number(rim.front().from()), body.number(rim.front().to())),
                     "a closed surface; " + way_to_close(body, rim, holes, key));
}

void refuse_inner_walls(const FileMesh& body, const std::vector<FaceSide>& sides)
{
    for_each_edge(sides, [&](const FaceSide* first, const FaceSide* end) {
        if ((end - first) % 2 == 0) return;
        throw InputError(
            body.at_face(first->face),
            fmt::format("more than two faces meet at the edge from vertex {} to {}{}: {} do", body.number(first->low),
                        body.number(first->high), at_text(body.mesh.vertices[first->low]), end - first),
            "a closed surface without inner walls");
    });
}

// The patches of faces that agree with their neighbours; the smaller one at the first edge is likely the turned one.
void refuse_turned_faces(const FileMesh& body, const std::vector<FaceSide>& sides)
{
    JoinedSets sets(body.mesh.faces.size());
    long long bad = 0;
    const FaceSide* first_bad = nullptr;
    for_each_edge(sides, [&](const FaceSide* first, const FaceSide* end) {
        int balance = 0;
        for (const FaceSide* side = first; side < end; ++side) balance += side->forward ? 1 : -1;
        if (balance == 0 && end - first == 2) sets.join(first[0].face, first[1].face);
        if (balance != 0 && bad++ == 0) first_bad = first;
    });
    if (!first_bad) return;
    const Pieces patches = pieces_of(sets, body.mesh.faces.size());
    int patch = patches.of_face[first_bad[0].face];
    if (const int other = patches.of_face[first_bad[1].face]; patches.face_count[other] < patches.face_count[patch])
        patch = other;
    throw InputError(
        body.at_face(patches.first_face[patch]),
        fmt::format("faces that disagree on the outside across {}, the first from vertex {} to {}{}: {} from "
                    "this line on look the other way than their neighbours",
                    counted(bad, "edge", "edges"), body.number(first_bad->low), body.number(first_bad->high),
                    at_text(body.mesh.vertices[first_bad->low]),
                    counted(patches.face_count[patch], "triangle", "triangles")),
        outward);
}

}  // namespace

void examine_body_size(const Scene& scene, int index, const std::string& file, double extent,
                       std::vector<Finding>& findings)
{
    if (extent >= BodyLimits::usual_smallest && extent <= BodyLimits::usual_largest) return;
    const BodyScene& body = scene.bodies[index];
    const std::string key = fmt::format("body[{}]", index);
    const std::string other =
        fmt::format("{0}.unit or {0}.scale: it would be {1}", key, sizes_by_unit(extent, body.unit));
    if (!(extent >= BodyLimits::smallest && extent <= BodyLimits::largest))
        throw InputError(
            {file, 0, 0, {}}, "a body that measures " + rounded_text(extent) + " m",
            "a body of " + range_text(BodyLimits::smallest, BodyLimits::largest, "m") + "; check " + other);
    const bool meant = scene.places.count(key + ".unit") > 0 || scene.places.count(key + ".scale") > 0;
    findings.push_back({"unit",
                        {file, 0, 0, {}},
                        fmt::format("the body measures {:.3g} m", extent),
                        "if that is not meant, set " + other,
                        meant ? Severity::note : Severity::warning});
}

void examine_body(FileMesh& body, const std::string& key, std::vector<Finding>& findings)
{
    const std::vector<FaceSide> sides = sorted_sides(body.mesh.faces);
    refuse_holes(body, sides, key);
    refuse_inner_walls(body, sides);
    refuse_turned_faces(body, sides);
    const Pieces pieces = pieces_by_edges(sides, body.mesh.faces.size());
    face_outward(body, pieces, findings);
    find_body_crossings(body, pieces, findings);
}

ObjMesh read_body(const BodyScene& given, const std::string& file)
{
    ObjMesh mesh = read_obj(file, given.unit, given.up_axis);
    for (Vec3& x : mesh.vertices) x *= given.scale;
    return mesh;
}

FileMesh load_body(const Scene& scene, int index, const std::string& file, std::vector<Finding>& findings)
{
    FileMesh body = cut_polygons(read_body(scene.bodies[index], file), findings);
    examine_body_size(scene, index, file, extent_of(body.mesh.vertices), findings);
    weld(scene, index, body, findings);
    close_holes(scene, index, body, findings);
    examine_body(body, fmt::format("body[{}]", index), findings);
    return body;
}

}  // namespace selvage
