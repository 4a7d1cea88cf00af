#include "host/garment/sheet.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <set>

#include <Eigen/Geometry>

#include "host/garment/assemble.hpp"
#include "host/garment/outline.hpp"
#include "host/garment/panel_mesh.hpp"

namespace selvage {
namespace {

constexpr double jitter = 0.27;          // of the grid spacing, for irregular rectangles
constexpr double flat_tolerance = 1e-5;  // of the extent, for meshes without texture coordinates

Mat3 turned(const Vec3& degrees)
{
    const Vec3 angle = degrees * std::numbers::pi / 180;
    return (Eigen::AngleAxisd(angle.z(), Vec3::UnitZ()) * Eigen::AngleAxisd(angle.y(), Vec3::UnitY()) *
            Eigen::AngleAxisd(angle.x(), Vec3::UnitX()))
        .toRotationMatrix();
}

// A number in [-1, 1] that depends on the index only (Steele, Lea and Flood 2014, SplitMix64).
double scatter(std::uint64_t index)
{
    std::uint64_t bits = (index + 1) * 0x9e3779b97f4a7c15ull;
    bits = (bits ^ (bits >> 30)) * 0xbf58476d1ce4e5b9ull;
    bits = (bits ^ (bits >> 27)) * 0x94d049bb133111ebull;
    return double((bits ^ (bits >> 31)) >> 11) / 4503599627370496.0 - 1;
}

// The faces of a grid, its points jittered off the lattice. The rim is put first for the triangulation.
std::vector<Face> irregular_faces(std::vector<Vec2>& points, int columns, int rows, const Vec2& spacing)
{
    std::vector<int> order;
    for (int i = 0; i < columns; ++i) order.push_back(i);
    for (int j = 1; j < rows; ++j) order.push_back(j * columns + columns - 1);
    for (int i = columns - 2; i >= 0; --i) order.push_back((rows - 1) * columns + i);
    for (int j = rows - 2; j > 0; --j) order.push_back(j * columns);
    const int rim = int(order.size());
    for (int j = 1; j + 1 < rows; ++j)
        for (int i = 1; i + 1 < columns; ++i) {
            const int vertex = j * columns + i;
            points[vertex] += jitter * Vec2(spacing.x() * scatter(2 * std::uint64_t(vertex)),
                                            spacing.y() * scatter(2 * std::uint64_t(vertex) + 1));
            order.push_back(vertex);
        }
    std::vector<Vec2> ordered;
    ordered.reserve(order.size());
    for (const int vertex : order) ordered.push_back(points[vertex]);
    std::vector<Face> faces = triangulate_points(ordered, rim);
    for (Face& face : faces) {
        for (int& vertex : face) vertex = order[vertex];
        std::rotate(face.begin(), std::min_element(face.begin(), face.end()), face.end());
    }
    std::sort(faces.begin(), faces.end());
    return faces;
}

std::vector<Face> grid_faces(int columns, int rows, bool alternating)
{
    std::vector<Face> faces;
    faces.reserve(2 * std::size_t(columns - 1) * (rows - 1));
    for (int j = 0; j + 1 < rows; ++j)
        for (int i = 0; i + 1 < columns; ++i) {
            const int a = j * columns + i, b = a + 1, c = b + columns, d = a + columns;
            if (alternating && (i + j) % 2 == 1) {
                faces.push_back({a, b, d});
                faces.push_back({b, c, d});
            } else {
                faces.push_back({a, b, c});
                faces.push_back({a, c, d});
            }
        }
    return faces;
}

void fill_rectangle(const SheetScene& sheet, Cloth& cloth, const InputPlace& place)
{
    const int columns = sheet.resolution;
    const int rows = std::max(2, int(std::lround((columns - 1) * sheet.height / sheet.width)) + 1);
    if (double(columns) * rows > 1e9)
        throw InputError({place.file, 0, 0, place.key + ".resolution"},
                         std::to_string(columns) + " x " + std::to_string(rows) + " vertices", "fewer than 1e9");
    const Vec2 spacing(sheet.width / (columns - 1), sheet.height / (rows - 1));
    for (int j = 0; j < rows; ++j)
        for (int i = 0; i < columns; ++i)
            cloth.panel_coordinates.push_back(
                {i * spacing.x() - 0.5 * sheet.width, j * spacing.y() - 0.5 * sheet.height});
    if (sheet.mesh_family == "irregular")
        cloth.faces = irregular_faces(cloth.panel_coordinates, columns, rows, spacing);
    else if (sheet.mesh_family == "alternating" || sheet.mesh_family == "same_diagonal")
        cloth.faces = grid_faces(columns, rows, sheet.mesh_family == "alternating");
    else
        throw InputError({place.file, 0, 0, place.key + ".mesh_family"}, "`" + sheet.mesh_family + "`",
                         "alternating, same_diagonal or irregular");
}

void fill_disc(const SheetScene& sheet, Cloth& cloth)
{
    const double edge_length = 2 * sheet.radius / (sheet.resolution - 1);
    const int count = std::max(6, int(std::lround(2 * std::numbers::pi * sheet.radius / edge_length)));
    std::vector<Vec2> circle;
    for (int i = 0; i < count; ++i) {
        const double angle = 2 * std::numbers::pi * i / count;
        circle.push_back(sheet.radius * Vec2(std::cos(angle), std::sin(angle)));
    }
    PanelMesh mesh = mesh_panel(circle, edge_length);
    renumber_for_locality(mesh.vertices, mesh.faces);
    cloth.panel_coordinates = std::move(mesh.vertices);
    cloth.faces = std::move(mesh.faces);
}

double face_area(const Cloth& cloth, const Face& face)
{
    return signed_area(
        {cloth.panel_coordinates[face[0]], cloth.panel_coordinates[face[1]], cloth.panel_coordinates[face[2]]});
}

// Fills in the one panel, its area and the length of its rim: sides that belong to a single face.
void describe_panel(const SheetScene& sheet, Cloth& cloth, const InputPlace& place)
{
    ClothPanel panel{place.key, sheet.fabric, 0, int(cloth.panel_coordinates.size()), 0, int(cloth.faces.size()), 0, 0};
    std::vector<std::array<int, 3>> sides;  // the smaller vertex, the larger one, and whether they run that way
    sides.reserve(3 * cloth.faces.size());
    for (const Face& face : cloth.faces) {
        panel.rest_area += face_area(cloth, face);
        for (int i = 0; i < 3; ++i) {
            const int a = face[i], b = face[(i + 1) % 3];
            sides.push_back({std::min(a, b), std::max(a, b), a < b ? 1 : 0});
        }
    }
    std::sort(sides.begin(), sides.end());
    for (std::size_t i = 0; i < sides.size(); ++i) {
        const auto same = [&](std::size_t j) {
            return j < sides.size() && sides[i][0] == sides[j][0] && sides[i][1] == sides[j][1];
        };
        if (same(i + 1)) {
            ++i;
            if (sides[i] == sides[i - 1] || same(i + 1))
                throw InputError({place.file, 0, 0, place.key + ".mesh"},
                                 "more than one face on the same side of the edge between vertices " +
                                     std::to_string(sides[i][0]) + " and " + std::to_string(sides[i][1]),
                                 "a sheet of cloth: at most two faces at an edge, facing the same way");
            continue;
        }
        panel.rest_boundary += (cloth.panel_coordinates[sides[i][0]] - cloth.panel_coordinates[sides[i][1]]).norm();
    }
    cloth.panels = {panel};
}

std::vector<int> listed_vertices(const std::string& list, int vertex_count, const std::string& file)
{
    const auto fail = [&](const std::string& found) {
        throw InputError({file, 0, 0, "pins.vertices"}, found,
                         "indices from 0 to " + std::to_string(vertex_count - 1) + ", separated by commas");
    };
    std::vector<int> vertices;
    for (std::size_t at = 0; at < list.size();) {
        const std::size_t comma = std::min(list.find(',', at), list.size());
        std::string word = list.substr(at, comma - at);
        word.erase(std::remove(word.begin(), word.end(), ' '), word.end());
        int vertex = -1;
        const auto [end, fault] = std::from_chars(word.data(), word.data() + word.size(), vertex);
        if (fault != std::errc() || end != word.data() + word.size() || vertex < 0 || vertex >= vertex_count)
            fail("`" + word + "`");
        vertices.push_back(vertex);
        at = comma + 1;
    }
    return vertices;
}

// The vertices nearest to the corners of the bounding box: lower left, lower right, upper left, upper right.
std::array<int, 4> corner_vertices(const std::vector<Vec2>& points, const Vec2& low, const Vec2& high)
{
    const std::array<Vec2, 4> corners{low, Vec2(high.x(), low.y()), Vec2(low.x(), high.y()), high};
    std::array<int, 4> nearest{0, 0, 0, 0};
    for (int corner = 0; corner < 4; ++corner)
        for (int vertex = 1; vertex < int(points.size()); ++vertex)
            if ((points[vertex] - corners[corner]).squaredNorm() <
                (points[nearest[corner]] - corners[corner]).squaredNorm())
                nearest[corner] = vertex;
    return nearest;
}

void pin(const PinsScene& pins, Cloth& cloth, const std::string& file)
{
    const std::vector<Vec2>& points = cloth.panel_coordinates;
    Vec2 low = points.front(), high = points.front();
    for (const Vec2& point : points) {
        low = low.cwiseMin(point);
        high = high.cwiseMax(point);
    }
    const double tolerance = 1e-6 * (high - low).maxCoeff();
    std::set<int> held;
    const auto hold_edge = [&](int axis, double place) {
        for (int vertex = 0; vertex < int(points.size()); ++vertex)
            if (std::abs(points[vertex][axis] - place) <= tolerance) held.insert(vertex);
    };
    const std::array<int, 4> corners = corner_vertices(points, low, high);
    if (pins.sheet == "corners")
        held.insert(corners.begin(), corners.end());
    else if (pins.sheet == "top_corners")
        held.insert(corners.begin() + 2, corners.end());
    else if (pins.sheet == "top_edge")
        hold_edge(1, high.y());
    else if (pins.sheet == "left_edge")
        hold_edge(0, low.x());
    else if (pins.sheet == "two_rows") {
        hold_edge(0, low.x());
        const std::set<int> first = held;
        for (const Face& face : cloth.faces)
            if (std::any_of(face.begin(), face.end(), [&](int vertex) { return first.count(vertex) > 0; }))
                held.insert(face.begin(), face.end());
    } else if (pins.sheet != "none")
        throw InputError({file, 0, 0, "pins.sheet"}, "`" + pins.sheet + "`",
                         "none, corners, top_corners, top_edge, left_edge or two_rows");
    for (const int vertex : listed_vertices(pins.vertices, int(points.size()), file)) held.insert(vertex);
    cloth.pinned.assign(held.begin(), held.end());
}

// Returns the mesh's own plane coordinates; a horizontal mesh keeps its x and y.
std::vector<Vec2> flat_coordinates(const TriangleMesh& mesh, const Vec3& middle, double extent, const InputPlace& place)
{
    Vec3 normal = Vec3::Zero();
    for (const Face& face : mesh.faces)
        normal +=
            (mesh.vertices[face[1]] - mesh.vertices[face[0]]).cross(mesh.vertices[face[2]] - mesh.vertices[face[0]]);
    normal.normalize();
    const Vec3 level = Vec3(-normal.y(), normal.x(), 0);
    const Vec3 weft = level.norm() > 1e-6 ? level.normalized() : Vec3(1, 0, 0);
    const Vec3 warp = normal.cross(weft);
    std::vector<Vec2> points;
    for (const Vec3& vertex : mesh.vertices) {
        const Vec3 arm = vertex - middle;
        if (!(std::abs(arm.dot(normal) - (mesh.vertices.front() - middle).dot(normal)) <= flat_tolerance * extent))
            throw InputError({place.file, 0, 0, place.key + ".mesh"},
                             "a mesh that is neither flat nor has texture coordinates",
                             "texture coordinates in metres, which give the rest shape");
        points.push_back({arm.dot(weft), arm.dot(warp)});
    }
    return points;
}

// Makes faces counter-clockwise in panel coordinates, mirroring a rest shape that is seen from behind.
void orient(Cloth& cloth, const InputPlace& place)
{
    double total = 0;
    for (const Face& face : cloth.faces) total += face_area(cloth, face);
    if (total < 0)
        for (Vec2& point : cloth.panel_coordinates) point.x() = -point.x();
    for (std::size_t face = 0; face < cloth.faces.size(); ++face)
        if (!(face_area(cloth, cloth.faces[face]) > 0))
            throw InputError({place.file, 0, 0, place.key + ".mesh"},
                             "face " + std::to_string(face) + " without area or turned over in the rest shape",
                             "faces that all turn the same way in texture coordinates");
}

}  // namespace

Cloth make_sheet(const SheetScene& sheet, const PinsScene& pins, const std::string& file, const std::string& key)
{
    Cloth cloth;
    if (sheet.shape == "rectangle")
        fill_rectangle(sheet, cloth, {file, 0, 0, key});
    else if (sheet.shape == "disc")
        fill_disc(sheet, cloth);
    else
        throw InputError({file, 0, 0, key + ".shape"}, "`" + sheet.shape + "`", "rectangle or disc");
    const Mat3 rotation = turned(sheet.rotation);
    for (const Vec2& point : cloth.panel_coordinates)
        cloth.positions.push_back(rotation * Vec3(point.x(), point.y(), 0) + sheet.center);
    describe_panel(sheet, cloth, {file, 0, 0, key});
    pin(pins, cloth, file);
    return cloth;
}

Cloth sheet_from_mesh(const TriangleMesh& mesh, const std::vector<Vec2>& texture_coordinates, const SheetScene& sheet,
                      const PinsScene& pins, const std::string& file, const std::string& key)
{
    const InputPlace place{file, 0, 0, key};
    if (mesh.vertices.empty() || mesh.faces.empty())
        throw InputError({file, 0, 0, key + ".mesh"}, "a mesh without faces", "at least one triangle");
    if (!texture_coordinates.empty() && texture_coordinates.size() != mesh.vertices.size())
        throw InputError({file, 0, 0, key + ".mesh"},
                         std::to_string(texture_coordinates.size()) + " texture coordinates",
                         std::to_string(mesh.vertices.size()) + ", one per vertex");
    Vec3 low = mesh.vertices.front(), high = low;
    for (const Vec3& vertex : mesh.vertices) {
        low = low.cwiseMin(vertex);
        high = high.cwiseMax(vertex);
    }
    const Vec3 middle = 0.5 * (low + high);
    Cloth cloth;
    cloth.faces = mesh.faces;
    cloth.panel_coordinates = texture_coordinates.empty()
                                  ? flat_coordinates(mesh, middle, (high - low).maxCoeff(), place)
                                  : texture_coordinates;
    orient(cloth, place);
    const Mat3 rotation = turned(sheet.rotation);
    for (const Vec3& vertex : mesh.vertices) cloth.positions.push_back(rotation * (vertex - middle) + sheet.center);
    describe_panel(sheet, cloth, place);
    pin(pins, cloth, file);
    return cloth;
}

}  // namespace selvage
