#pragma once
#include <Eigen/Core>

#include "host/model/cloth_model.hpp"
#include "host/solver/state/state.hpp"
#include "host/solver/state/topology.hpp"

namespace selvage {

/// Which springs a phase has.
struct SpringChoice {
    bool membrane = false;  ///< Structural and shear springs: triangle edges, and second diagonals of near-rectangles.
    bool bending = false;   ///< Bend springs, across every hinge.
    bool elastic = false;   ///< Along every Cloth::elastics.
};

/// The curvature at which a bend spring stores the energy of a hinge [1/m]: a fold of 2 cm radius. A straight spring
/// resists bending at fourth order only, so flatter cloth is softer than the fabric, sharper folds are stiffer.
constexpr double bend_spring_curvature = 50;

/// Puts the springs of a cloth into its topology.
///
/// Membrane (after Provot 1995). A spring of constant k and length l along the unit vector t = (a, b) in a face of area
/// A has, per area, the energy c/2 (t.e.t)^2 with c = k l^2 / A at small strain e, so springs show the moduli
///     C_uu = sum c a^4,   C_vv = sum c b^4,   C_s = sum c a^2 b^2,
/// and the two that mix tension and shear, sum c a^3 b and sum c a b^3. The shear modulus C_s is also the coupling of
/// weft and warp (Cauchy's relation), whatever the fabric says. Each face chooses its c >= 0 so that these are ku, kv,
/// ks and, a hundred times less urgently, 0, in the least squares sense: on a right triangle with legs along weft and
/// warp and r = width / height, the long side has c = ks / (a^2 b^2), which is 4 ks for r = 1, and the legs have
/// ku - ks r^2 and kv - ks / r^2.
/// Two faces that form nearly a rectangle also have its other diagonal; each takes half the shear. Constants of faces
/// that share an edge add up. On a grid these moduli hold exactly. On irregular triangles they hold on average only:
/// vertices give way between uneven neighbours, and a mesh whose vertices are shifted by 15 (25, 35) % of an edge shows
/// 0.96 (0.88, 0.71) of the weft and 0.90 (0.75, 0.58) of the shear stiffness once its inner vertices are at rest.
///
/// Bending. Opposite corners at heights h1, h2 over an edge come nearer by h1 h2 (1 - cos theta) / l. With the hinge
/// energy c_h theta^2 / 2, c_h = D |e|^2 / (A1 + A2), both agree at theta_r = bend_spring_curvature (h1 + h2) / 2 if
///     k = 4 c_h l^2 / (h1 h2 theta_r)^2        (small theta_r).
/// Bend springs also resist stretch: stiff cloth on a coarse mesh is stiffer in its plane than its fabric.
///
/// Elastic of the stiffness K that is sewn to an edge at r of its length has, along each triangle edge of length e, a
/// spring of the length r e and the constant K / (r e).
///
/// A spring's limit is its elongation in cloth that is stretched both ways and sheared to the fabric's limits.
void add_springs(Topology& topology, const Cloth& cloth, const FabricTable& fabrics, const SpringChoice& choice);

/// Copies the springs into an allocated state; does nothing where there are none.
void fill_springs(State& state, const Topology& topology);

/// Least squares of moduli * c = target with c >= 0 for a few unknowns, by trying every set of positive ones.
Eigen::VectorXd fit_non_negative(const Eigen::MatrixXd& moduli, const Eigen::VectorXd& target);

}  // namespace selvage
