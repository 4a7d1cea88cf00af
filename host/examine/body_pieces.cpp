#include "host/examine/body_pieces.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <Eigen/Geometry>

#include "host/mesh/exact_orientation.hpp"
#include "host/mesh/self_intersections.hpp"
#include "host/mesh/triangle_tree.hpp"

namespace selvage {
namespace {

constexpr double no_volume = 1e-12;  // of the cubed extent: within the rounding error of its computation

std::string name_of(const FileMesh& body, const Pieces& pieces, int piece)
{
    const int first = pieces.first_face[piece];
    std::string part;
    for (const MeshPart& p : body.mesh.parts)
        if (first >= p.first_face && first < p.first_face + p.face_count && !p.name.empty())
            part = "`" + p.name + "`, ";
    if (pieces.count() == 1) return "the body";
    return fmt::format("piece {} of {} ({}{}{})", piece + 1, pieces.count(), part,
                       counted(pieces.face_count[piece], "triangle", "triangles"),
                       at_text(body.mesh.vertices[body.mesh.faces[first][0]]));
}

// How often the other pieces wind around a point of each piece, counted along rays in the direction of x: 0 outside.
std::vector<int> windings(const TriangleMesh& mesh, const Pieces& pieces)
{
    std::vector<int> winding(pieces.count());
    if (pieces.count() < 2) return winding;
    double end = mesh.vertices.front().x();
    for (const Vec3& x : mesh.vertices) end = std::max(end, x.x());
    std::vector<Vec3> ends;
    std::vector<Face> rays;
    for (const int f : pieces.first_face) {
        // Off the edges and off every symmetry of the mesh, so that the ray meets no edge.
        const Vec3 &a = mesh.vertices[mesh.faces[f][0]], &b = mesh.vertices[mesh.faces[f][1]],
                   &c = mesh.vertices[mesh.faces[f][2]];
        const Vec3 from = a + 0.3123 * (b - a) + 0.2718 * (c - a);
        const int first = int(ends.size());
        rays.push_back({first, first + 1, first + 1});
        ends.insert(ends.end(), {from, Vec3(end + 1, from.y(), from.z())});
    }
    const TriangleTree ray_tree(ends, rays), surface(mesh.vertices, mesh.faces);
    const auto crosses = [&](int ray, int f) {
        if (pieces.of_face[f] == ray) return 0;
        const Triangle t = surface.triangle(f);
        const Vec3 &p = ends[rays[ray][0]], &q = ends[rays[ray][1]];
        const int at_p = exact_orientation(t[0], t[1], t[2], p), at_q = exact_orientation(t[0], t[1], t[2], q);
        if (at_p == at_q) return 0;
        for (int k = 0; k < 3; ++k)
            if (exact_orientation(p, q, t[k], t[(k + 1) % 3]) != exact_orientation(p, q, t[0], t[1])) return 0;
        return at_q > at_p ? 1 : -1;  // out of the piece, or into it
    };
    for (const auto& [ray, f] : ray_tree.pairs_with(surface, [&](int r, int f) { return crosses(r, f) != 0; }))
        winding[ray] += crosses(ray, f);
    return winding;
}

void turn_all(FileMesh& body, std::vector<Finding>& findings)
{
    for (Face& face : body.mesh.faces) std::swap(face[1], face[2]);
    findings.push_back({"inward",
                        {body.file(), 0, 0, {}},
                        "all faces of the body look inward; they are turned around",
                        {},
                        Severity::note});
}

}  // namespace

std::vector<double> piece_volumes(const TriangleMesh& mesh, const Pieces& pieces)
{
    std::vector<double> volume(pieces.count());
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
        const int piece = pieces.of_face[f];
        const Vec3& origin = mesh.vertices[mesh.faces[pieces.first_face[piece]][0]];
        const auto [a, b, c] = mesh.faces[f];
        volume[piece] +=
            (mesh.vertices[a] - origin).dot((mesh.vertices[b] - origin).cross(mesh.vertices[c] - origin)) / 6;
    }
    return volume;
}

void face_outward(FileMesh& body, const Pieces& pieces, std::vector<Finding>& findings)
{
    const std::vector<double> volume = piece_volumes(body.mesh, pieces);
    const std::vector<int> winding = windings(body.mesh, pieces);
    const double extent = extent_of(body.mesh.vertices);
    int outer = 0, inward = 0, cavities = 0, first_inward = -1;
    for (int p = 0; p < pieces.count(); ++p) {
        if (std::abs(volume[p]) <= no_volume * std::pow(extent, 3))
            throw InputError(body.at_face(pieces.first_face[p]),
                             name_of(body, pieces, p) + " without volume: it is flat", "a solid");
        if (winding[p] != 0) {
            cavities += volume[p] < 0;
            continue;
        }
        ++outer;
        if (volume[p] < 0 && inward++ == 0) first_inward = p;
    }
    if (inward > 0 && inward == outer) return turn_all(body, findings);
    if (inward > 0)
        throw InputError(body.at_face(pieces.first_face[first_inward]),
                         fmt::format("{} inside out (volume {:.3g} m^3) where others are not; {} so",
                                     name_of(body, pieces, first_inward), volume[first_inward],
                                     counted(inward, "piece is", "pieces are")),
                         "all faces counter-clockwise seen from outside: turn the faces of that piece around");
    if (cavities > 0)
        findings.push_back(
            {"cavity",
             {body.file(), 0, 0, {}},
             counted(cavities, "piece faces", "pieces face") + " inward inside others: taken as cavities",
             {},
             Severity::note});
}

void find_body_crossings(const FileMesh& body, const Pieces& pieces, std::vector<Finding>& findings)
{
    long long own = 0, mutual = 0;
    IntersectingPair first_own{}, first_mutual{};
    for (const IntersectingPair& pair : self_intersections(body.mesh.vertices, body.mesh.faces)) {
        const bool same = pieces.of_face[pair[0]] == pieces.of_face[pair[1]];
        if ((same ? own : mutual)++ == 0) (same ? first_own : first_mutual) = pair;
    }
    const auto face_text = [&](int face) {
        const int line = body.at_face(face).line;
        return line > 0 ? fmt::format("the face at line {}", line) : std::string("one that closes a hole");
    };
    const auto told = [&](const IntersectingPair& pair) {
        return face_text(pair[0]) + " and " + face_text(pair[1]) +
               at_text(body.mesh.vertices[body.mesh.faces[pair[0]][0]]);
    };
    if (own > 0)
        findings.push_back({"body_self_intersection", body.at_face(first_own[0]),
                            fmt::format("{} of the body's surface intersect, the first are {}",
                                        counted(own, "pair of triangles", "pairs of triangles"), told(first_own)),
                            "cloth may be pushed the wrong way there: part the surface, unless it is out of reach"});
    if (mutual > 0)
        findings.push_back({"overlapping_pieces",
                            body.at_face(first_mutual[0]),
                            fmt::format("pieces of the body touch or overlap in {}, the first are {}",
                                        counted(mutual, "pair of triangles", "pairs of triangles"), told(first_mutual)),
                            {},
                            Severity::note});
}

}  // namespace selvage
