#include "host/solver/state/springs.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Dense>

#include "host/model/cloth_model.hpp"

namespace selvage {
namespace {

constexpr double nearly = 0.1;         // by which a rectangle's diagonals may differ, as a part of their length
constexpr double mixed_weight = 0.01;  // of the moduli that mix tension and shear

double cross(const Vec2& a, const Vec2& b) { return a.x() * b.y() - a.y() * b.x(); }

// A face at rest: its corners in the panel, the fabric, and the end of a second diagonal if it is half a rectangle.
struct RestFace {
    std::array<Vec2, 3> corner;
    double area = 0;
    const Fabric* fabric = nullptr;
    int partner_corner = -1;  // corner from which the second diagonal starts; -1: none
    int partner_particle = -1;
    Vec2 second_diagonal = Vec2::Zero();
};

std::vector<RestFace> rest_faces(const Cloth& cloth, const FabricTable& fabrics)
{
    std::vector<RestFace> faces(cloth.faces.size());
    for (const ClothPanel& panel : cloth.panels)
        for (int f = panel.first_face; f < panel.first_face + panel.face_count; ++f) {
            for (int k = 0; k < 3; ++k) faces[f].corner[k] = cloth.panel_coordinates[cloth.faces[f][k]];
            faces[f].area =
                0.5 * cross(faces[f].corner[1] - faces[f].corner[0], faces[f].corner[2] - faces[f].corner[0]);
            faces[f].fabric = &fabrics.at(panel.fabric);
        }
    return faces;
}

int corner_of(const Face& face, int particle)
{
    return int(std::find(face.begin(), face.end(), particle) - face.begin());
}

// Finds the pairs of faces that form nearly a rectangle across the longest edge of both; so a face is in at most
// one pair.
void pair_rectangles(const Topology& topology, const Cloth& cloth, std::vector<RestFace>& faces)
{
    for (int h = 0; h < int(topology.hinges.size()); ++h) {
        const auto [f, g] = topology.hinge_faces[h];
        const int kf = corner_of(topology.faces[f], topology.hinges[h][2]);
        const int kg = corner_of(topology.faces[g], topology.hinges[h][3]);
        if (cloth.faces[f][(kf + 1) % 3] != cloth.faces[g][(kg + 2) % 3] ||
            cloth.faces[f][(kf + 2) % 3] != cloth.faces[g][(kg + 1) % 3])
            continue;  // a seam
        const Vec2 a = faces[f].corner[(kf + 1) % 3], b = faces[f].corner[(kf + 2) % 3];
        const Vec2 c = faces[f].corner[kf], d = faces[g].corner[kg];
        const double diagonal = (b - a).norm();
        if (std::max({(c - a).norm(), (c - b).norm(), (d - a).norm(), (d - b).norm()}) > diagonal) continue;
        if (((a + b) - (c + d)).norm() > 2 * nearly * diagonal) continue;
        if (std::abs((d - c).norm() - diagonal) > nearly * diagonal) continue;
        const auto join = [&](RestFace& face, int corner, int particle, const Vec2& way) {
            face.partner_corner = corner;
            face.partner_particle = particle;
            face.second_diagonal = way;
        };
        join(faces[f], kf, topology.hinges[h][3], d - c);
        join(faces[g], kg, topology.hinges[h][2], c - d);
    }
}

// The moduli that a unit c along a direction shows: weft, warp, shear, and the two mixed ones. Shear counts six times,
// as often as its component stands in the tensor; the mixed ones four times.
Eigen::VectorXd moduli_along(const Vec2& way)
{
    const Vec2 t = way.normalized();
    const double a = t.x(), b = t.y();
    Eigen::VectorXd moduli(5);
    moduli << a * a * a * a, b * b * b * b, std::sqrt(6.0) * a * a * b * b, 2 * mixed_weight * a * a * a * b,
        2 * mixed_weight * a * b * b * b;
    return moduli;
}

double limit_strain(const Fabric& fabric, const Vec2& way)
{
    if (fabric.stretch_limit <= 0) return std::numeric_limits<double>::infinity();
    const Vec2 t = way.normalized();
    const double stretch = membrane_point(CurveMeasure::tension, {fabric.stretch_limit, 0}).x();
    const double shear = membrane_point(CurveMeasure::shear, {fabric.shear_limit, 0}).x();
    return measured_point(CurveMeasure::tension, {stretch + std::abs(t.x() * t.y()) * shear, 0}).x();
}

Spring make_spring(int from, int to, const Vec2& way, double constant, const Fabric& fabric)
{
    Spring spring;
    spring.vertex = {std::min(from, to), std::max(from, to)};
    spring.length = way.norm();
    spring.constant = constant;
    spring.limit_length = spring.length * (1 + limit_strain(fabric, way));
    spring.limit_constant = constant * fabric.stretch_limit_factor;
    return spring;
}

void add_face_springs(const Face& particles, const RestFace& face, std::vector<Spring>& springs)
{
    std::vector<Vec2> ways;
    std::vector<std::array<int, 2>> ends;
    for (int k = 0; k < 3; ++k) {
        ways.push_back(face.corner[(k + 1) % 3] - face.corner[k]);
        ends.push_back({particles[k], particles[(k + 1) % 3]});
    }
    if (face.partner_corner >= 0) {
        ways.push_back(face.second_diagonal);
        ends.push_back({particles[face.partner_corner], face.partner_particle});
    }
    Eigen::MatrixXd moduli(5, int(ways.size()));
    for (int k = 0; k < int(ways.size()); ++k) moduli.col(k) = moduli_along(ways[k]);
    Eigen::VectorXd wanted(5);
    wanted << face.fabric->stretch_weft, face.fabric->stretch_warp, std::sqrt(6.0) * face.fabric->shear, 0, 0;
    const Eigen::VectorXd c = fit_non_negative(moduli, wanted);
    for (int k = 0; k < int(ways.size()); ++k)
        if (c[k] > 0)
            springs.push_back(
                make_spring(ends[k][0], ends[k][1], ways[k], c[k] * face.area / ways[k].squaredNorm(), *face.fabric));
}

// Springs of one pair of particles become one; where two panels meet, its length is their weighted mean.
std::vector<Spring> merged(std::vector<Spring> springs)
{
    std::stable_sort(springs.begin(), springs.end(),
                     [](const Spring& a, const Spring& b) { return a.vertex < b.vertex; });
    std::vector<Spring> result;
    for (const Spring& spring : springs) {
        if (result.empty() || result.back().vertex != spring.vertex) {
            result.push_back(spring);
            continue;
        }
        Spring& sum = result.back();
        const double share = spring.constant / (sum.constant + spring.constant);
        sum.length += share * (spring.length - sum.length);
        // Where one panel has no limit, the joined spring has none.
        sum.limit_length = std::isinf(sum.limit_length) ? sum.limit_length
                           : std::isinf(spring.limit_length)
                               ? spring.limit_length
                               : sum.limit_length + share * (spring.limit_length - sum.limit_length);
        sum.constant += spring.constant;
        sum.limit_constant += spring.limit_constant;
    }
    return result;
}

// Height of the corner opposite a hinge's edge, where it stands along the edge, and the rigidity across it.
struct Wing {
    double height, along, rigidity, edge, area;
};

Wing wing_of(const RestFace& face, int corner, bool reversed)
{
    const Vec2 start = face.corner[(corner + (reversed ? 2 : 1)) % 3];
    const Vec2 end = face.corner[(corner + (reversed ? 1 : 2)) % 3];
    const Vec2 edge = end - start;
    const double squared = edge.squaredNorm(), length = std::sqrt(squared);
    const Fabric& f = *face.fabric;
    return {2 * face.area / length, (face.corner[corner] - start).dot(edge) / length,
            (f.bending_weft * edge.y() * edge.y() + f.bending_warp * edge.x() * edge.x()) / squared, length, face.area};
}

void add_bend_springs(const Topology& topology, const std::vector<RestFace>& faces, std::vector<Spring>& springs)
{
    for (int h = 0; h < int(topology.hinges.size()); ++h) {
        const auto& hinge = topology.hinges[h];
        const auto [f, g] = topology.hinge_faces[h];
        const int kf = corner_of(topology.faces[f], hinge[2]), kg = corner_of(topology.faces[g], hinge[3]);
        const Wing one = wing_of(faces[f], kf, topology.faces[f][(kf + 1) % 3] != hinge[0]);
        const Wing two = wing_of(faces[g], kg, topology.faces[g][(kg + 1) % 3] != hinge[0]);
        const double edge = 0.5 * (one.edge + two.edge);
        const double c = 0.5 * (one.rigidity + two.rigidity) * edge * edge / (one.area + two.area);
        const double angle = 0.5 * bend_spring_curvature * (one.height + two.height);
        const double length = std::hypot(one.height + two.height, two.along - one.along);
        const double lever = one.height * two.height * angle;
        if (!(c > 0) || !(lever > 0)) continue;
        Spring spring;
        spring.vertex = {hinge[2], hinge[3]};
        spring.length = length;
        spring.constant = spring.limit_constant = 4 * c * length * length / (lever * lever);
        spring.limit_length = std::numeric_limits<double>::infinity();
        spring.kind = SpringKind::bend;
        springs.push_back(spring);
    }
}

void add_elastic_springs(const Topology& topology, const Cloth& cloth, std::vector<Spring>& springs)
{
    for (const Elastic& elastic : cloth.elastics)
        for (std::size_t k = 0; k + 1 < elastic.vertices.size(); ++k) {
            const int a = elastic.vertices[k], b = elastic.vertices[k + 1];
            Spring spring;
            spring.vertex = {topology.particle_of[a], topology.particle_of[b]};
            if (spring.vertex[0] == spring.vertex[1]) continue;
            spring.length = elastic.shrink * (cloth.panel_coordinates[a] - cloth.panel_coordinates[b]).norm();
            spring.constant = spring.limit_constant = elastic.stiffness / spring.length;
            spring.limit_length = std::numeric_limits<double>::infinity();
            spring.kind = SpringKind::elastic;
            springs.push_back(spring);
        }
}

}  // namespace

Eigen::VectorXd fit_non_negative(const Eigen::MatrixXd& moduli, const Eigen::VectorXd& target)
{
    const int count = int(moduli.cols());
    Eigen::VectorXd best = Eigen::VectorXd::Zero(count);
    double least = target.norm();
    for (int set = (1 << count) - 1; set > 0; --set) {
        std::vector<int> active;
        for (int k = 0; k < count; ++k)
            if (set >> k & 1) active.push_back(k);
        const Eigen::MatrixXd part = moduli(Eigen::all, active);
        const Eigen::VectorXd c = part.completeOrthogonalDecomposition().solve(target);
        const double misfit = (part * c - target).norm();
        if (c.minCoeff() < 0 || misfit >= least) continue;
        least = misfit;
        best.setZero();
        best(active) = c;
        if (int(active.size()) == count) break;  // nothing was held back
    }
    return best;
}

void add_springs(Topology& topology, const Cloth& cloth, const FabricTable& fabrics, const SpringChoice& choice)
{
    if (choice.elastic) add_elastic_springs(topology, cloth, topology.springs);
    if (!choice.membrane && !choice.bending) return;
    std::vector<RestFace> faces = rest_faces(cloth, fabrics);
    if (choice.membrane) {
        pair_rectangles(topology, cloth, faces);
        std::vector<Spring> springs;
        for (int f = 0; f < int(faces.size()); ++f) add_face_springs(topology.faces[f], faces[f], springs);
        springs = merged(std::move(springs));
        topology.springs.insert(topology.springs.end(), springs.begin(), springs.end());
    }
    if (choice.bending) add_bend_springs(topology, faces, topology.springs);
}

void fill_springs(State& state, const Topology& topology)
{
    if (state.spring_vertex.empty()) return;
    const int ss = state.size.spring_stride;
    for (int s = 0; s < int(topology.springs.size()); ++s) {
        const Spring& spring = topology.springs[s];
        for (int k = 0; k < 2; ++k) state.spring_vertex[k * ss + s] = spring.vertex[k];
        state.spring_length[s] = spring.length;
        state.spring_constant[s] = spring.constant;
        state.spring_constant[ss + s] = spring.limit_constant;
        state.spring_limit[s] = std::min(spring.limit_length, double(std::numeric_limits<float>::max()));
        state.spring_kind[s] = int(spring.kind);
    }
}

}  // namespace selvage
