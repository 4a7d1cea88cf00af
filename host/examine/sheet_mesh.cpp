#include "host/examine/sheet_mesh.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

#include <fmt/format.h>
#include <Eigen/Dense>

#include "host/examine/file_mesh.hpp"
#include "host/examine/mesh_edges.hpp"
#include "host/examine/sizes.hpp"
#include "host/examine/weld.hpp"
#include "host/mesh/body_tessellation.hpp"
#include "io/mesh/length_unit.hpp"
#include "io/number_text.hpp"

namespace selvage {
namespace {

// Chosen by hand: cloth is hardly ever drawn so far from its rest shape on purpose.
struct SheetLimits {
    static constexpr double rest_length = 1.5;           // rest over drawn length, or the reverse, of a whole sheet
    static constexpr double fits = 1.12;                 // the same within which another unit fits
    static constexpr double most_stretch = 2;            // of one triangle, and its inverse for pressing
    static constexpr double smallest = 0.02, most = 20;  // [m]
};

// A sheet while it is being loaded.
struct Draft {
    FileMesh source;
    JoinedSets point_of;       ///< Vertices of the source that are one point.
    std::vector<Face> faces;   ///< Of the source, over points.
    std::string key;           ///< As `sheet[0]`.
    double weld_distance = 0;  ///< [m]
};

// Returns for every texture coordinate the first of the same value, so that repeated ones count as one.
std::vector<int> first_equal(const std::vector<Vec2>& texture)
{
    std::vector<Vec3> points;
    for (const Vec2& t : texture) points.emplace_back(t.x(), t.y(), 0);
    return first_coincident_vertex(points);
}

void require_all_textures(const FileMesh& source)
{
    for (std::size_t f = 0; f < source.face_textures.size(); ++f)
        for (int k = 0; k < 3; ++k)
            if (source.face_textures[f][k] < 0)
                throw InputError(
                    source.at_face(int(f)),
                    fmt::format("vertex {} without texture coordinates", source.number(source.mesh.faces[f][k])),
                    "texture coordinates at every corner, as other corners have them");
}

// A side of the rim with what stands at its ends, the lower place first.
struct TexturedSide {
    std::array<int, 2> places, vertices, textures;
};

// Joins the rims that lie on each other where texture coordinates differ: the sheet was cut there for its rest shape.
void join_along_texture(const FileMesh& source, JoinedSets& sets)
{
    const std::vector<int> place = first_coincident_vertex(source.mesh.vertices);
    const std::vector<int> equal = first_equal(source.obj.texture);
    std::vector<TexturedSide> sides;
    for (const FaceSide& side : rim_sides(sorted_sides(source.mesh.faces))) {
        const Face &face = source.mesh.faces[side.face], &textures = source.face_textures[side.face];
        std::array<std::array<int, 3>, 2> ends;
        for (int e = 0; e < 2; ++e) {
            const int vertex = e ? side.high : side.low;
            const auto corner = std::find(face.begin(), face.end(), vertex) - face.begin();
            ends[e] = {place[vertex], vertex, equal[textures[corner]]};
        }
        if (ends[0][0] > ends[1][0]) std::swap(ends[0], ends[1]);
        sides.push_back({{ends[0][0], ends[1][0]}, {ends[0][1], ends[1][1]}, {ends[0][2], ends[1][2]}});
    }
    std::sort(sides.begin(), sides.end(), [](const TexturedSide& a, const TexturedSide& b) {
        return std::tie(a.places, a.vertices) < std::tie(b.places, b.vertices);
    });
    for (std::size_t begin = 0; begin < sides.size(); ++begin)
        for (std::size_t other = begin + 1; other < sides.size() && sides[other].places == sides[begin].places; ++other)
            if (sides[other].textures != sides[begin].textures)
                for (int e = 0; e < 2; ++e) sets.join(sides[begin].vertices[e], sides[other].vertices[e]);
}

// Makes one vertex of every point and texture coordinate that occur together, in the order of the file.
void split_by_texture(Draft& draft, double unit, LoadedSheet& sheet)
{
    const FileMesh& source = draft.source;
    const std::vector<int> equal = first_equal(source.obj.texture);
    const auto corner = [&](std::size_t f, int k) {
        return std::array{draft.faces[f][k], equal.empty() ? 0 : equal[source.face_textures[f][k]]};
    };
    std::vector<std::array<int, 2>> corners;
    for (std::size_t f = 0; f < draft.faces.size(); ++f)
        for (int k = 0; k < 3; ++k) corners.push_back(corner(f, k));
    std::sort(corners.begin(), corners.end());
    corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
    for (std::size_t c = 0, first = 0; c < corners.size(); ++c) {
        const auto [point, texture] = corners[c];
        if (point != corners[first][0]) first = c;
        if (first != c) sheet.joined.push_back({int(first), int(c)});
        sheet.mesh.vertices.push_back(source.mesh.vertices[point]);
        if (!equal.empty()) sheet.rest.push_back(unit * source.obj.texture[texture]);
    }
    for (std::size_t f = 0; f < draft.faces.size(); ++f) {
        Face& face = sheet.mesh.faces.emplace_back();
        for (int k = 0; k < 3; ++k)
            face[k] = int(std::lower_bound(corners.begin(), corners.end(), corner(f, k)) - corners.begin());
    }
    for (int v = 0; v < int(source.mesh.vertices.size()); ++v) {
        const int point = draft.point_of.root(v);
        for (auto c = std::ranges::lower_bound(corners, std::array{point, -1}); c != corners.end() && (*c)[0] == point;
             ++c)
            sheet.numbers.push_back({source.vertex_source[v], int(c - corners.begin())});
    }
    for (int f = 0; f < int(source.mesh.faces.size()); ++f) sheet.face_lines.push_back(source.at_face(f).line);
}

double rest_area(const LoadedSheet& sheet, const Face& face)
{
    const Vec2 a = sheet.rest[face[1]] - sheet.rest[face[0]], b = sheet.rest[face[2]] - sheet.rest[face[0]];
    return 0.5 * (a.x() * b.y() - a.y() * b.x());
}

// Mirrors the pieces of the rest shape that are seen from behind.
void turn_charts(LoadedSheet& sheet)
{
    const Pieces charts = pieces_by_edges(sorted_sides(sheet.mesh.faces), sheet.mesh.faces.size());
    std::vector<double> area(charts.count());
    for (std::size_t f = 0; f < sheet.mesh.faces.size(); ++f)
        area[charts.of_face[f]] += rest_area(sheet, sheet.mesh.faces[f]);
    std::vector<char> turns(sheet.rest.size());
    for (std::size_t f = 0; f < sheet.mesh.faces.size(); ++f)
        for (const int v : sheet.mesh.faces[f]) turns[v] = turns[v] || area[charts.of_face[f]] < 0;
    for (std::size_t v = 0; v < turns.size(); ++v)
        if (turns[v]) sheet.rest[v].x() = -sheet.rest[v].x();
}

// Vertices at the place of others: joined ones are a note, others make cloth fall apart.
void find_coincident(Draft& draft, const Pieces& pieces, const LoadedSheet& sheet, std::vector<Finding>& findings)
{
    const FileMesh& source = draft.source;
    const std::vector<int> place = first_coincident_vertex(source.mesh.vertices);
    long long loose = 0, joined = 0;
    int first = -1;
    for (int v = 0; v < int(place.size()); ++v) {
        if (draft.point_of.root(v) != v) {
            ++joined;
        } else if (place[v] != v && draft.point_of.root(place[v]) != v) {
            if (loose++ == 0) first = v;
        }
    }
    if (joined > 0)
        findings.push_back({"weld",
                            {source.file(), 0, 0, {}},
                            fmt::format("{} joined to others {}, {} of them across a seam of the rest shape",
                                        counted(joined, "vertex is", "vertices are"),
                                        draft.weld_distance > 0 ? "within " + rounded_text(draft.weld_distance) + " m"
                                                                : "at the same place",
                                        sheet.joined.size()),
                            draft.key + ".weld says which are",
                            Severity::note});
    if (loose > 0)
        findings.push_back(
            {"coincident_vertices", source.at_vertex(first),
             fmt::format(
                 "{} on others without being joined to them, the first is vertex {} on vertex {}{}: the sheet is "
                 "of {}",
                 counted(loose, "vertex lies", "vertices lie"), source.number(first), source.number(place[first]),
                 at_text(source.mesh.vertices[first]),
                 counted(pieces.count(), "piece", "pieces that nothing holds together")),
             draft.key + ".weld = \"exact\" joins them"});
    else if (pieces.count() > 1)
        findings.push_back(
            {"pieces",
             source.at_face(pieces.first_face[1]),
             fmt::format("the sheet is of {} pieces that nothing holds together, of {} and {} triangles{}; "
                         "the second begins here",
                         pieces.count(), pieces.face_count[0], pieces.face_count[1],
                         pieces.count() > 2 ? " and so on" : ""),
             {},
             Severity::note});
}

void find_vertices_on_edges(const Draft& draft, const std::vector<FaceSide>& rim, std::vector<Finding>& findings)
{
    const FileMesh& source = draft.source;
    const std::vector<VertexOnEdge> found = vertices_on_rims(source.mesh.vertices, rim);
    if (found.empty()) return;
    const VertexOnEdge& one = found.front();
    findings.push_back(
        {"vertex_on_edge", source.at_vertex(one.vertex),
         fmt::format("{} on edges of other faces without being a corner of them, the first is vertex {} on "
                     "the edge from vertex {} to {}{}: the cloth is open there and touches itself",
                     counted(int(found.size()), "vertex lies", "vertices lie"), source.number(one.vertex),
                     source.number(one.from), source.number(one.to), at_text(source.mesh.vertices[one.vertex])),
         "make it a corner of the faces at that edge, or move it away", Severity::fault});
}

// The unit in which the texture coordinates would fit the mesh.
std::string fitting_unit(double length_ratio, const Draft& draft, LengthUnit now)
{
    for (std::size_t k = 0; k < words_of<LengthUnit>().size(); ++k) {
        const double ratio = length_ratio * metres_per(LengthUnit(k)) / metres_per(now);
        if (ratio < SheetLimits::fits && ratio > 1 / SheetLimits::fits)
            return fmt::format("in {0} they would fit: {1}.texture_unit = \"{0}\"", word_of(LengthUnit(k)), draft.key);
    }
    return fmt::format("multiplied by {:.4g} they would fit", 1 / length_ratio);
}

void find_rest_area(const Draft& draft, const LoadedSheet& sheet, LengthUnit unit, std::vector<Finding>& findings)
{
    double rest = 0, drawn = 0;
    for (const Face& face : sheet.mesh.faces) {
        rest += rest_area(sheet, face);
        drawn += area_of(sheet.mesh.vertices, face);
    }
    const double ratio = std::sqrt(rest / drawn);
    if (ratio < SheetLimits::rest_length && ratio > 1 / SheetLimits::rest_length) return;
    findings.push_back(
        {"rest_area",
         {draft.source.file(), 0, 0, {}},
         fmt::format("the rest area by the texture coordinates, {:.3g} m^2, is {:.4g} times the area of the "
                     "mesh, {:.3g} m^2: the cloth starts {} by {:.3g} %",
                     rest, ratio * ratio, drawn, ratio < 1 ? "stretched" : "pressed together",
                     100 * std::abs(1 / ratio - 1)),
         fmt::format("texture coordinates count as lengths in {}; {}", word_of(unit),
                     fitting_unit(ratio, draft, unit))});
}

// The larger and the smaller principal stretch of a triangle from its rest shape to its start.
Vec2 stretches(const LoadedSheet& sheet, const Face& face)
{
    Eigen::Matrix<double, 3, 2> drawn;
    Mat2 rest;
    for (int k = 0; k < 2; ++k) {
        drawn.col(k) = sheet.mesh.vertices[face[k + 1]] - sheet.mesh.vertices[face[0]];
        rest.col(k) = sheet.rest[face[k + 1]] - sheet.rest[face[0]];
    }
    const Eigen::Matrix<double, 3, 2> gradient = drawn * rest.inverse();
    const Mat2 squared = gradient.transpose() * gradient;
    const double mean = 0.5 * squared.trace(), spread = std::sqrt(std::max(0.0, mean * mean - squared.determinant()));
    return {std::sqrt(mean + spread), std::sqrt(std::max(0.0, mean - spread))};
}

void find_strain(const Draft& draft, const LoadedSheet& sheet, std::vector<Finding>& findings)
{
    Finding finding{"strain", {}, {}};
    double worst = 1;
    int at = 0;
    for (int f = 0; f < int(sheet.mesh.faces.size()); ++f) {
        const Face& face = sheet.mesh.faces[f];
        if (!(rest_area(sheet, face) > 0)) return;  // refused later on
        const Vec2 stretch = stretches(sheet, face);
        const double most = std::max(stretch.x(), 1 / stretch.y());
        if (most > SheetLimits::most_stretch) finding.faces.push_back(f);
        if (most > worst) at = f;
        worst = std::max(worst, most);
    }
    if (finding.faces.empty()) return;
    finding.place = draft.source.at_face(at);
    const Vec2 stretch = stretches(sheet, sheet.mesh.faces[at]);
    finding.text =
        fmt::format("{} to less than half or more than twice the rest length, most to {:.3g} and {:.3g} times",
                    counted(int(finding.faces.size()), "triangle starts stretched or pressed",
                            "triangles start stretched or pressed"),
                    stretch.x(), stretch.y());
    finding.way_on = "check the texture coordinates there";
    findings.push_back(finding);
}

void find_odd_size(const Draft& draft, const SheetScene& scene, std::vector<Finding>& findings)
{
    const double extent = extent_of(draft.source.mesh.vertices);
    if (extent >= SheetLimits::smallest && extent <= SheetLimits::most) return;
    findings.push_back({"unit",
                        {draft.source.file(), 0, 0, {}},
                        fmt::format("the sheet measures {:.3g} m", extent),
                        fmt::format("{}.unit sets the unit of the file: it would be {}", draft.key,
                                    sizes_by_unit(extent, scene.unit))});
}

}  // namespace

LoadedSheet load_sheet(const Scene& scene, int index, std::vector<Finding>& findings)
{
    const SheetScene& given = scene.sheets[index];
    const std::string key = fmt::format("sheet[{}]", index);
    FileMesh source = cut_polygons(read_obj(scene.resolve(given.mesh), given.unit, given.up_axis), findings);
    const std::size_t vertex_count = source.mesh.vertices.size();
    Draft draft{std::move(source), JoinedSets(vertex_count), {}, key};
    const FileMesh& mesh = draft.source;
    require_all_textures(mesh);
    const bool textured = !mesh.face_textures.empty();
    const WeldRule weld = weld_rule(given.weld, true, scene.place(key + ".weld"));
    if (weld.seams && textured) join_along_texture(mesh, draft.point_of);
    draft.weld_distance = weld.distance;
    if (weld.any) join_near(mesh, weld.distance, scene.place(key + ".weld"), draft.point_of);
    draft.faces = mesh.mesh.faces;
    for (Face& face : draft.faces)
        for (int& v : face) v = draft.point_of.root(v);

    LoadedSheet sheet;
    sheet.file = mesh.file();
    if (!textured) draft.source.obj.texture.clear();
    split_by_texture(draft, metres_per(given.texture_unit), sheet);
    if (textured) turn_charts(sheet);

    const std::vector<FaceSide> sides = sorted_sides(draft.faces);
    find_coincident(draft, pieces_by_edges(sides, draft.faces.size()), sheet, findings);
    find_vertices_on_edges(draft, rim_sides(sides), findings);
    find_odd_size(draft, given, findings);
    const std::size_t before = findings.size();
    if (textured) find_rest_area(draft, sheet, given.texture_unit, findings);
    if (textured && findings.size() == before) find_strain(draft, sheet, findings);
    return sheet;
}

}  // namespace selvage
