#include "host/solver/state/plate_mesh.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Dense>

#include "host/model/cloth_model.hpp"

namespace selvage {
namespace {

Vec2 left_of(const Vec2& v) { return Vec2(-v.y(), v.x()); }

// The row over (xx, yy, xy) that gives p^T S q.
Vec3 product(const Vec2& p, const Vec2& q) { return Vec3(p.x() * q.x(), p.y() * q.y(), p.x() * q.y() + p.y() * q.x()); }

Mat3 bending_stiffness(const Fabric& fabric)
{
    Mat3 stiffness = Mat3::Zero();
    stiffness(0, 0) = fabric.bending_weft;
    stiffness(1, 1) = fabric.bending_warp;
    stiffness(0, 1) = stiffness(1, 0) = fabric.bending_coupling;
    stiffness(2, 2) = twist_rigidity(fabric);
    return stiffness;
}

std::vector<char> held_particles(const Topology& topology, const Cloth& cloth)
{
    std::vector<char> held(topology.particle_count);
    for (int v : cloth.pinned) held[topology.particle_of[v]] = 1;
    return held;
}

}  // namespace

PlateMesh::PlateMesh(const Topology& topology, const Cloth& cloth, const FabricTable& fabrics)
    : faces_(cloth.faces.size()), faces_of_(topology.hinge_faces), corners_of_(topology.hinges.size()),
      signs_(topology.hinges.size())
{
    const std::vector<char> held = held_particles(topology, cloth);
    for (const ClothPanel& panel : cloth.panels)
        for (int f = panel.first_face; f < panel.first_face + panel.face_count; ++f) {
            PlateFace& face = faces_[f];
            face.fabric = &fabrics.at(panel.fabric);
            const Face& corners = topology.faces[f];
            face.rigid = held[corners[0]] && held[corners[1]] && held[corners[2]];
            std::array<Vec2, 3> x;
            for (int k = 0; k < 3; ++k) x[k] = cloth.panel_coordinates[cloth.faces[f][k]];
            const Vec2 a = x[1] - x[0], b = x[2] - x[0];
            face.area = 0.5 * (a.x() * b.y() - a.y() * b.x());
            for (int k = 0; k < 3; ++k) {
                const Vec2 from = x[(k + 1) % 3], edge = x[(k + 2) % 3] - from;
                const double length = edge.norm();
                const Vec2 along = edge / length;
                face.edge[k] = {along, left_of(along), length, 2 * face.area / length, (x[k] - from).dot(along)};
            }
        }
    for (int h = 0; h < hinge_count(); ++h) {
        std::array<bool, 2> forwards;  // does the face run along the edge from the hinge's first end to its second?
        for (int s = 0; s < 2; ++s) {
            const Face& corners = topology.faces[face(h, s)];
            const int k = int(std::find(corners.begin(), corners.end(), topology.hinges[h][2 + s]) - corners.begin());
            corners_of_[h][s] = k;
            forwards[s] = corners[(k + 1) % 3] == topology.hinges[h][0];
        }
        signs_[h] = forwards[0] != forwards[1] ? 1 : -1;
        if (rigid(face(h, 0)) && rigid(face(h, 1))) continue;
        for (int s = 0; s < 2; ++s) faces_[face(h, s)].hinge[corner(h, s)] = h;
    }
}

double PlateMesh::rigidity(int face) const
{
    return 0.5 * (faces_[face].fabric->bending_weft + faces_[face].fabric->bending_warp);
}

PlacedFace PlateMesh::across(const PlacedFace& from, int k) const
{
    const int h = hinge(from.face, k), other = 1 - side(h, from.face), next = face(h, other);
    // Both faces run counter-clockwise, so the shared edge runs against itself unless one panel is turned over.
    const Vec2 here = faces_[from.face].edge[k].along;
    const Vec2 there = -signs_[h] * faces_[next].edge[corner(h, other)].along;
    const Mat2 unfold = here * there.transpose() + signs_[h] * left_of(here) * left_of(there).transpose();
    return {next, from.map * unfold, from.sign * signs_[h]};
}

Vec3 PlateMesh::side_row(const PlacedFace& at, int k) const
{
    const Edge& edge = faces_[at.face].edge[k];
    const Vec2 t = at.map * edge.along, n = at.map * edge.inward;
    const double w = edge.foot, l = edge.length, h = edge.altitude;
    return h / 2 * product(n, n) + (w - l / 2) * product(t, n) - w * (l - w) / (2 * h) * product(t, t);
}

Vec3 PlateMesh::turn_row(const PlacedFace& at, int k) const
{
    const int h = hinge(at.face, k), here = side(h, at.face);
    const PlacedFace beyond = across(at, k);
    Vec3 row = Vec3::Zero();
    if (!rigid(at.face)) row += side_row(at, k);
    if (!rigid(beyond.face)) row += side_row(beyond, corner(h, 1 - here));
    return at.sign * (here == 0 ? 1 : signs_[h]) * row;
}

Vec3 PlateMesh::curvature_of_turn(int face, int k) const
{
    const Edge& edge = faces_[face].edge[k];
    const Vec2 n = edge.inward;
    return edge.length / faces_[face].area * Vec3(n.x() * n.x(), n.y() * n.y(), n.x() * n.y());
}

Mat3 PlateMesh::free_stiffness(int face) const
{
    Mat3 stiffness = bending_stiffness(*faces_[face].fabric);
    for (int k = 0; k < 3; ++k) {
        if (hinge(face, k) >= 0) continue;
        const Vec3 n = curvature_of_turn(face, k).normalized();
        const Vec3 moment = stiffness * n;
        const double across = n.dot(moment);
        // A curvature that no moment resists any more, as at a second free edge, has nothing left to release.
        if (across > 1e-12 * stiffness.trace()) stiffness -= moment * moment.transpose() / across;
    }
    return rigid(face) ? Mat3::Zero() : stiffness;
}

}  // namespace selvage
