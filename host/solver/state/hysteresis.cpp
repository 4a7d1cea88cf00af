#include "host/solver/state/hysteresis.hpp"

#include <algorithm>

#include <Eigen/Dense>

#include "host/model/cloth_model.hpp"
#include "host/solver/state/plate_mesh.hpp"

namespace selvage {
namespace {

constexpr double largest_factor = 2;  // of a panel too narrow for its few hinges to mean anything on average

// Edge length times the squared components of the edge's normal, weft and warp [m].
Vec2 across_edge(const PlateMesh& mesh, int face, int k)
{
    return mesh.area(face) * mesh.curvature_of_turn(face, k).head<2>();
}

// What cylinders along weft (row 0) and warp (row 1) do on a panel.
struct Work {
    Mat2 per_moment = Mat2::Zero();  // area that moments per width given along weft and warp (columns) work on [m^2]
    Vec2 area = Vec2::Zero();        // [m^2]
};

void add_face(const PlateMesh& mesh, int face, Work& work)
{
    Vec2 carrying(1, 1);
    for (int k = 0; k < 3; ++k) {
        const Vec2 across = across_edge(mesh, face, k);
        if (mesh.hinge(face, k) < 0) {
            carrying -= across / across.sum();
            continue;
        }
        const Vec3 turn = mesh.turn_row({face, Mat2::Identity(), 1}, k);
        work.per_moment += 0.5 * turn.head<2>().cwiseAbs() * across.transpose();
    }
    if (!mesh.rigid(face)) work.area += mesh.area(face) * carrying.cwiseMax(0);
}

// Moments per width that make both cylinders show `friction`, none of them negative.
Vec2 balanced_moments(const Work& work, const Vec2& friction)
{
    const Mat2& m = work.per_moment;
    if (!(m.determinant() > 1e-6 * m(0, 0) * m(1, 1)) || !(work.area.minCoeff() > 0)) return friction;
    const Vec2 wanted = friction.cwiseProduct(work.area);
    Vec2 moments = m.inverse() * wanted;
    for (int i : {0, 1})
        if (moments[i] < 0) {
            moments[i] = 0;
            moments[1 - i] = wanted[1 - i] / m(1 - i, 1 - i);
        }
    return moments.cwiseMin(largest_factor * friction);
}

}  // namespace

void fill_hysteresis(State& state, const Topology& topology, const Cloth& cloth, const FabricTable& fabrics)
{
    const PlateMesh mesh(topology, cloth, fabrics);
    std::vector<Vec2> moments(cloth.faces.size());  // per width, along weft and warp [N]
    for (const ClothPanel& panel : cloth.panels) {
        const Fabric& fabric = fabrics.at(panel.fabric);
        Work work;
        for (int f = panel.first_face; f < panel.first_face + panel.face_count; ++f) add_face(mesh, f, work);
        const Vec2 friction = 0.5 * Vec2(fabric.hysteresis_weft, fabric.hysteresis_warp);
        std::fill_n(moments.begin() + panel.first_face, panel.face_count, balanced_moments(work, friction));
    }
    for (int h = 0; h < mesh.hinge_count(); ++h)
        for (int s = 0; s < 2; ++s) {
            const int face = mesh.face(h, s);
            const Vec2 across = across_edge(mesh, face, mesh.corner(h, s));
            state.hinge_hysteresis[h] += 0.5 * across.dot(moments[face]);
            state.hinge_width[h] += mesh.area(face) / across.sum();
        }
}

}  // namespace selvage
