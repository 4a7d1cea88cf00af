#include "host/garment/sheet.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

#include "host/garment/outline.hpp"
#include "host/mesh/sheet_families.hpp"
#include "io/errors.hpp"

namespace selvage {
namespace {

constexpr double flat_tolerance = 1e-5;  // of the extent, for meshes without texture coordinates

Mat3 turned(const Vec3& degrees)
{
    const Vec3 angle = degrees * std::numbers::pi / 180;
    return (Eigen::AngleAxisd(angle.z(), Vec3::UnitZ()) * Eigen::AngleAxisd(angle.y(), Vec3::UnitY()) *
            Eigen::AngleAxisd(angle.x(), Vec3::UnitX()))
        .toRotationMatrix();
}

// The family of a sheet's triangles, checked.
MeshFamily mesh_family(const SheetScene& sheet, std::span<const MeshFamily> families, const InputPlace& place)
{
    if (sheet.mesh_family == MeshFamily::automatic) return families.front();
    if (std::find(families.begin(), families.end(), sheet.mesh_family) != families.end()) return sheet.mesh_family;
    std::string expected;
    std::vector<std::string> names;
    for (const MeshFamily family : families) {
        names.push_back(text_of(family));
        expected += (expected.empty() ? "" : family == families.back() ? " or " : ", ") + names.back();
    }
    const std::string found = text_of(sheet.mesh_family);
    throw InputError({place.file, 0, 0, place.key + ".mesh_family"}, "`" + found + "`",
                     expected + ", for a " + text_of(sheet.shape), nearest_name(found, names));
}

SheetMesh rectangle(const SheetScene& sheet, const InputPlace& place)
{
    const MeshFamily family = mesh_family(sheet, rectangle_families(), place);
    const double rows = (sheet.resolution - 1) * sheet.height / sheet.width + 1;
    if (sheet.resolution * rows > 1e9)
        throw InputError({place.file, 0, 0, place.key + ".resolution"},
                         std::to_string(sheet.resolution) + " x " + std::to_string(std::lround(rows)) + " vertices",
                         "fewer than 1e9");
    return rectangle_mesh(family, sheet.width, sheet.height, sheet.resolution);
}

double face_area(const Cloth& cloth, const Face& face)
{
    return signed_area(
        {cloth.panel_coordinates[face[0]], cloth.panel_coordinates[face[1]], cloth.panel_coordinates[face[2]]});
}

// The number of a vertex of the sheet in its file, from 1.
int number_in_file(const LoadedSheet& loaded, int vertex)
{
    const auto found = std::ranges::find_if(loaded.numbers, [&](const auto& number) { return number[1] == vertex; });
    return 1 + (found == loaded.numbers.end() ? vertex : (*found)[0]);
}

// Where a face of the sheet stands in its file.
InputPlace place_of_face(const LoadedSheet& loaded, const InputPlace& place, int face)
{
    if (loaded.face_lines.empty()) return {place.file, 0, 0, place.key + ".mesh"};
    return {loaded.file, loaded.face_lines[face], 0, {}};
}

// Fills in the one panel, its area and the length of its rim: sides that belong to a single face.
void describe_panel(const SheetScene& sheet, const LoadedSheet& loaded, Cloth& cloth, const InputPlace& place)
{
    const std::string& name = sheet.name.empty() ? place.key : sheet.name;
    ClothPanel panel{name,  sheet.fabric,  0, int(cloth.panel_coordinates.size()), 0, int(cloth.faces.size()), 0, 0,
                     false, loaded.numbers};
    // The smaller vertex, the larger one, whether they run that way, and the face.
    std::vector<std::array<int, 4>> sides;
    sides.reserve(3 * cloth.faces.size());
    for (int f = 0; f < int(cloth.faces.size()); ++f) {
        const Face& face = cloth.faces[f];
        panel.rest_area += face_area(cloth, face);
        for (int i = 0; i < 3; ++i) {
            const int a = face[i], b = face[(i + 1) % 3];
            sides.push_back({std::min(a, b), std::max(a, b), a < b ? 1 : 0, f});
        }
    }
    std::sort(sides.begin(), sides.end());
    for (std::size_t i = 0; i < sides.size(); ++i) {
        const auto same = [&](std::size_t j) {
            return j < sides.size() && sides[i][0] == sides[j][0] && sides[i][1] == sides[j][1];
        };
        if (same(i + 1)) {
            ++i;
            if (sides[i][2] == sides[i - 1][2] || same(i + 1))
                throw InputError(place_of_face(loaded, place, sides[i][3]),
                                 "more than one face on the same side of the edge between vertices " +
                                     std::to_string(number_in_file(loaded, sides[i][0])) + " and " +
                                     std::to_string(number_in_file(loaded, sides[i][1])),
                                 "a sheet of cloth: at most two faces at an edge, facing the same way");
            continue;
        }
        panel.rest_boundary += (cloth.panel_coordinates[sides[i][0]] - cloth.panel_coordinates[sides[i][1]]).norm();
    }
    cloth.panels = {panel};
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
                             "texture coordinates, which give the rest shape");
        points.push_back({arm.dot(weft), arm.dot(warp)});
    }
    return points;
}

// Makes faces counter-clockwise in panel coordinates, mirroring a rest shape that is seen from behind.
void orient(const LoadedSheet& loaded, Cloth& cloth, const InputPlace& place)
{
    double total = 0;
    for (const Face& face : cloth.faces) total += face_area(cloth, face);
    if (total < 0)
        for (Vec2& point : cloth.panel_coordinates) point.x() = -point.x();
    for (std::size_t face = 0; face < cloth.faces.size(); ++face)
        if (!(face_area(cloth, cloth.faces[face]) > 0))
            throw InputError(place_of_face(loaded, place, int(face)),
                             "a face without area or turned over in the rest shape",
                             "faces that all turn the same way in texture coordinates");
}

}  // namespace

Cloth make_sheet(const SheetScene& sheet, const std::string& file, const std::string& key)
{
    const InputPlace place{file, 0, 0, key};
    if (sheet.shape == SheetShape::mesh)
        throw InputError({file, 0, 0, key + ".shape"}, "`" + text_of(sheet.shape) + "`", "rectangle or disc");
    SheetMesh mesh = sheet.shape == SheetShape::rectangle
                         ? rectangle(sheet, place)
                         : disc_mesh(mesh_family(sheet, disc_families(), place), sheet.radius, sheet.resolution);
    Cloth cloth;
    cloth.panel_coordinates = std::move(mesh.points);
    cloth.faces = std::move(mesh.faces);
    const Mat3 rotation = turned(sheet.rotation);
    for (const Vec2& point : cloth.panel_coordinates)
        cloth.positions.push_back(rotation * Vec3(point.x(), point.y(), 0) + sheet.center);
    describe_panel(sheet, {}, cloth, place);
    return cloth;
}

Cloth sheet_from_mesh(const LoadedSheet& loaded, const SheetScene& sheet, const std::optional<Vec3>& center,
                      const std::string& file, const std::string& key)
{
    const InputPlace place{file, 0, 0, key};
    const TriangleMesh& mesh = loaded.mesh;
    Vec3 low = mesh.vertices.front(), high = low;
    for (const Vec3& vertex : mesh.vertices) {
        low = low.cwiseMin(vertex);
        high = high.cwiseMax(vertex);
    }
    const Vec3 middle = 0.5 * (low + high);
    Cloth cloth;
    cloth.faces = mesh.faces;
    cloth.panel_coordinates =
        loaded.rest.empty() ? flat_coordinates(mesh, middle, (high - low).maxCoeff(), place) : loaded.rest;
    orient(loaded, cloth, place);
    cloth.positions = mesh.vertices;
    if (center || !sheet.rotation.isZero(0)) {
        const Mat3 rotation = turned(sheet.rotation);
        for (Vec3& x : cloth.positions) x = rotation * (x - middle) + center.value_or(middle);
    }
    cloth.seam_pairs = loaded.joined;
    describe_panel(sheet, loaded, cloth, place);
    return cloth;
}

}  // namespace selvage
