#include "host/solver/state/plate.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Dense>

#include "host/model/cloth_model.hpp"
#include "host/parallel/launch.hpp"
#include "host/solver/state/plate_mesh.hpp"

namespace selvage {
namespace {

constexpr int widest_ring = 3;        // how far hinges are looked for where few are near, as at corners
constexpr double well_spread = 0.15;  // singular values of the hinges' rows beyond which all curvatures are seen
constexpr double share_low = -1, share_high = 2;  // outside, the mesh is too poor for matched shares

// Entries of a row over hinges, to be multiplied with their turns.
struct Weight {
    int hinge;
    double value;
};
using Share = std::vector<Weight>;

// The hinges around one, with the row that gives each one's turn from a quadratic surface.
struct Pool {
    std::vector<int> hinge;
    std::vector<Vec3> row;

    bool has(int h) const { return std::find(hinge.begin(), hinge.end(), h) != hinge.end(); }

    bool sees_all_curvatures() const
    {
        Mat3 sum = Mat3::Zero();
        for (const Vec3& r : row) sum += r.normalized() * r.normalized().transpose();
        const Vec3 squared = Eigen::SelfAdjointEigenSolver<Mat3>(sum, Eigen::EigenvaluesOnly).eigenvalues();
        return row.size() >= 3 && squared[0] > well_spread * well_spread * squared[2];
    }
};

void add_hinges(const PlateMesh& mesh, const PlacedFace& at, Pool& pool)
{
    for (int k = 0; k < 3; ++k) {
        const int h = mesh.hinge(at.face, k);
        if (h < 0 || !mesh.mixes(h) || pool.has(h)) continue;
        pool.hinge.push_back(h);
        pool.row.push_back(mesh.turn_row(at, k));
    }
}

Pool hinges_around(const PlateMesh& mesh, int hinge)
{
    const PlacedFace first = mesh.base(hinge);
    std::vector<PlacedFace> faces = {first, mesh.across(first, mesh.corner(hinge, 0))};
    Pool pool{{hinge}, {mesh.turn_row(first, mesh.corner(hinge, 0))}};
    for (int ring = 0; ring < widest_ring; ++ring) {
        for (const PlacedFace& at : faces) add_hinges(mesh, at, pool);
        if (pool.sees_all_curvatures()) break;
        for (int i = 0, end = int(faces.size()); i < end; ++i)
            for (int k = 0; k < 3; ++k) {
                const int h = mesh.hinge(faces[i].face, k);
                if (h < 0 || !mesh.mixes(h)) continue;
                const PlacedFace next = mesh.across(faces[i], k);
                const auto same = [&](const PlacedFace& f) { return f.face == next.face; };
                if (!mesh.rigid(next.face) && std::none_of(faces.begin(), faces.end(), same)) faces.push_back(next);
            }
    }
    return pool;
}

// The smallest change of the split by areas, each entry weighed by the size of its hinge's row, after which
// sum_h q_h row_h = m, the side angle of quadratic surfaces. Directions that no hinge sees are left as they are.
Share matched_share(const PlateMesh& mesh, int hinge, double by_area)
{
    const Pool pool = hinges_around(mesh, hinge);
    const int n = int(pool.hinge.size());
    Eigen::Matrix3Xd rows(3, n);
    for (int i = 0; i < n; ++i) rows.col(i) = pool.row[i] * (pool.row[0].norm() / pool.row[i].norm());
    const Vec3 missing = mesh.side_row(mesh.base(hinge), mesh.corner(hinge, 0)) - by_area * pool.row[0];
    const Eigen::SelfAdjointEigenSolver<Mat3> solver(rows * rows.transpose());
    Vec3 inverse = Vec3::Zero();
    for (int i = 0; i < 3; ++i)
        if (solver.eigenvalues()[i] > 1e-6 * solver.eigenvalues()[2]) inverse[i] = 1 / solver.eigenvalues()[i];
    const Vec3 multiplier = solver.eigenvectors() * inverse.asDiagonal() * solver.eigenvectors().transpose() * missing;
    Share share;
    for (int i = 0; i < n; ++i) {
        const double scale = pool.row[0].norm() / pool.row[i].norm();
        const double value = (i == 0 ? by_area : 0) + scale * rows.col(i).dot(multiplier);
        if (value < share_low || value > share_high) return {{hinge, by_area}};
        share.push_back({pool.hinge[i], value});
    }
    return share;
}

// The part of a hinge's turn that lies on the side of its first face.
Share first_share(const PlateMesh& mesh, int hinge)
{
    const int one = mesh.face(hinge, 0), two = mesh.face(hinge, 1);
    if (mesh.rigid(one)) return {};
    if (mesh.rigid(two)) return {{hinge, 1}};
    if (!mesh.mixes(hinge)) {  // the same moment bends both sides
        const double soft_one = mesh.area(one) / std::max(mesh.rigidity(one), 1e-30);
        const double soft_two = mesh.area(two) / std::max(mesh.rigidity(two), 1e-30);
        return {{hinge, soft_one / (soft_one + soft_two)}};
    }
    return matched_share(mesh, hinge, mesh.area(one) / (mesh.area(one) + mesh.area(two)));
}

// The curvature tensor (xx, yy, xy) of a face as a combination of hinge turns.
struct FaceRows {
    std::vector<int> hinge;
    std::vector<Vec3> curvature;

    void add(int h, const Vec3& value)
    {
        const auto at = std::find(hinge.begin(), hinge.end(), h);
        if (at != hinge.end()) {
            curvature[at - hinge.begin()] += value;
        } else {
            hinge.push_back(h);
            curvature.push_back(value);
        }
    }
};

FaceRows face_rows(const PlateMesh& mesh, const std::vector<Share>& shares, int face)
{
    FaceRows rows;
    for (int k = 0; k < 3 && !mesh.rigid(face); ++k) {
        const int h = mesh.hinge(face, k);
        if (h < 0) continue;
        const Vec3 unit = mesh.curvature_of_turn(face, k);
        const bool first = mesh.face(h, 0) == face;
        const double sign = first ? 1 : mesh.sign(h);
        if (!first) rows.add(h, sign * unit);
        for (const Weight& weight : shares[h]) rows.add(weight.hinge, (first ? 1 : -sign) * weight.value * unit);
    }
    return rows;
}

// Which faces take part in each row of G.
std::vector<std::vector<int>> faces_of_hinges(const std::vector<FaceRows>& rows, int hinge_count)
{
    std::vector<std::vector<int>> faces(hinge_count);
    for (int f = 0; f < int(rows.size()); ++f)
        for (int h : rows[f].hinge) faces[h].push_back(f);
    return faces;
}

std::vector<Weight> matrix_row(int hinge, const std::vector<int>& faces, const std::vector<FaceRows>& rows,
                               const std::vector<Mat3>& stiffness)
{
    std::vector<Weight> row = {{hinge, 0}};
    for (int f : faces) {
        const FaceRows& r = rows[f];
        const auto own = std::find(r.hinge.begin(), r.hinge.end(), hinge) - r.hinge.begin();
        const Vec3 moment = stiffness[f] * r.curvature[own];
        for (int i = 0; i < int(r.hinge.size()); ++i) row.push_back({r.hinge[i], moment.dot(r.curvature[i])});
    }
    std::stable_sort(row.begin(), row.end(), [](const Weight& a, const Weight& b) { return a.hinge < b.hinge; });
    int last = 0;
    for (int i = 1; i < int(row.size()); ++i) {
        if (row[i].hinge == row[last].hinge)
            row[last].value += row[i].value;
        else
            row[++last] = row[i];
    }
    row.resize(std::size_t(last) + 1);
    return row;
}

}  // namespace

PlateMatrix make_plate(const Topology& topology, const Cloth& cloth, const FabricTable& fabrics)
{
    const PlateMesh mesh(topology, cloth, fabrics);
    const int hinges = mesh.hinge_count(), faces = mesh.face_count();
    std::vector<Share> shares(hinges);
    for_each_item(hinges, [&mesh, to = shares.data()](int h) { to[h] = first_share(mesh, h); });
    std::vector<FaceRows> rows(faces);
    std::vector<Mat3> stiffness(faces);
    for_each_item(faces, [&mesh, &shares, to = rows.data(), stiff = stiffness.data()](int f) {
        to[f] = face_rows(mesh, shares, f);
        stiff[f] = mesh.area(f) * mesh.free_stiffness(f);
    });
    const std::vector<std::vector<int>> users = faces_of_hinges(rows, hinges);
    std::vector<std::vector<Weight>> matrix(hinges);
    for_each_item(hinges, [&, to = matrix.data()](int h) { to[h] = matrix_row(h, users[h], rows, stiffness); });

    std::vector<double> diagonal(hinges);
    for (int h = 0; h < hinges; ++h)
        for (const Weight& w : matrix[h])
            if (w.hinge == h) diagonal[h] = w.value;
    PlateMatrix plate;
    plate.row_begin.assign(1, 0);
    for (int h = 0; h < hinges; ++h) {
        for (const Weight& w : matrix[h]) {
            // Regular meshes leave most entries at rounding noise; the test is the same for both halves.
            if (w.hinge != h && w.value * w.value <= 1e-16 * diagonal[h] * diagonal[w.hinge]) continue;
            plate.column.push_back(w.hinge);
            plate.entry.push_back(float(w.value));
        }
        plate.row_begin.push_back(int(plate.column.size()));
    }
    plate.own = std::move(diagonal);
    return plate;
}

void fill_plate(State& state, const PlateMatrix& plate)
{
    const int hs = state.size.hinge_stride;
    for (int h = 0; h < int(plate.own.size()); ++h) {
        state.coupling_slots[h] = plate.row_begin[h];
        state.coupling_slots[hs + h] = plate.row_begin[std::size_t(h) + 1];
        state.plate_diagonal[h] = plate.own[h];
    }
    std::copy(plate.column.begin(), plate.column.end(), state.coupling_hinge.begin());
    std::copy(plate.entry.begin(), plate.entry.end(), state.coupling_rigidity.begin());
}

}  // namespace selvage
