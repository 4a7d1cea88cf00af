#include "host/run/measure.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "host/parallel/launch.hpp"
#include "host/solver/state/planes.hpp"

namespace selvage {
namespace {

// Square roots of the eigenvalues of the right Cauchy-Green tensor C = F^T F, the larger one last.
// @param a, b  from the first corner to the others
std::array<double, 2> principal_stretches(const std::array<Vec2, 3>& rest, const Vec3& a, const Vec3& b)
{
    const Vec2 p = rest[1] - rest[0], q = rest[2] - rest[0];
    const double area = p.x() * q.y() - p.y() * q.x();
    const Vec3 weft = (q.y() * a - p.y() * b) / area, warp = (p.x() * b - q.x() * a) / area;
    const double uu = weft.squaredNorm(), vv = warp.squaredNorm(), uv = weft.dot(warp);
    const double mean = 0.5 * (uu + vv), radius = std::hypot(0.5 * (uu - vv), uv);
    return {std::sqrt(std::max(mean - radius, 0.0)), std::sqrt(mean + radius)};
}

// @param position_of  of a vertex [m]
template <class PositionOf>
FaceStretch largest_of(const Cloth& cloth, const PositionOf& position_of, double above)
{
    const std::vector<Vec2>& u = cloth.panel_coordinates;
    const ItemValue largest = largest_item(int(cloth.faces.size()), above, [&](int face) {
        const Face& f = cloth.faces[face];
        const Vec3 x = position_of(f[0]);
        return principal_stretches({u[f[0]], u[f[1]], u[f[2]]}, position_of(f[1]) - x, position_of(f[2]) - x)[1] - 1;
    });
    return {.stretch = largest.value, .face = largest.item};
}

// Edges of a panel that belong to one of its faces only.
std::vector<std::array<int, 2>> boundary_edges(const Cloth& cloth, const ClothPanel& panel)
{
    std::map<std::array<int, 2>, int> uses;
    for (int f = panel.first_face; f < panel.first_face + panel.face_count; ++f)
        for (int k = 0; k < 3; ++k) {
            const int a = cloth.faces[f][k], b = cloth.faces[f][(k + 1) % 3];
            ++uses[{std::min(a, b), std::max(a, b)}];
        }
    std::vector<std::array<int, 2>> edges;
    for (const auto& [edge, count] : uses)
        if (count == 1) edges.push_back(edge);
    return edges;
}

}  // namespace

StretchMeasure measure_stretch(const std::vector<std::array<Vec2, 3>>& rest_corners, const std::vector<Face>& faces,
                               const std::vector<Vec3>& positions)
{
    StretchMeasure measure;
    if (faces.empty()) return measure;
    std::vector<double> strains;
    strains.reserve(2 * faces.size());
    const std::vector<Vec3>& x = positions;
    for (std::size_t f = 0; f < faces.size(); ++f) {
        const auto [a, b, c] = faces[f];
        for (double stretch : principal_stretches(rest_corners[f], x[b] - x[a], x[c] - x[a]))
            strains.push_back(stretch - 1);
    }
    const auto low = std::ranges::min_element(strains), high = std::ranges::max_element(strains);
    measure.min = *low;
    measure.max = *high;
    measure.max_face = int(high - strains.begin()) / 2;
    for (double& strain : strains) strain = std::abs(strain);
    const auto at = strains.begin() + std::ptrdiff_t(0.99 * double(strains.size() - 1));
    std::nth_element(strains.begin(), at, strains.end());
    measure.p99 = *at;
    return measure;
}

FaceStretch largest_stretch(const Cloth& cloth, const std::vector<Vec3>& positions, double above)
{
    return largest_of(
        cloth, [&](int vertex) -> const Vec3& { return positions[vertex]; }, above);
}

FaceStretch largest_stretch(const Cloth& cloth, const Phase& phase, double above)
{
    const State& state = phase.state();
    const ConstPlanes planes = vertex_planes(state.size, state.pos);
    const std::vector<int>& particle_of = phase.topology().particle_of;
    return largest_of(
        cloth, [&](int vertex) -> Vec3 { return planes(particle_of[vertex]); }, above);
}

std::vector<PanelMeasure> measure_panels(const Cloth& cloth, const std::vector<Vec3>& x)
{
    std::vector<PanelMeasure> measures;
    for (const ClothPanel& panel : cloth.panels) {
        double area = 0, flat_area = 0, boundary = 0, flat_boundary = 0;
        for (int f = panel.first_face; f < panel.first_face + panel.face_count; ++f) {
            const Face& c = cloth.faces[f];
            area += 0.5 * (x[c[1]] - x[c[0]]).cross(x[c[2]] - x[c[0]]).norm();
            const Vec2 a = cloth.panel_coordinates[c[1]] - cloth.panel_coordinates[c[0]];
            const Vec2 b = cloth.panel_coordinates[c[2]] - cloth.panel_coordinates[c[0]];
            flat_area += 0.5 * (a.x() * b.y() - a.y() * b.x());
        }
        for (const auto& [a, b] : boundary_edges(cloth, panel)) {
            boundary += (x[a] - x[b]).norm();
            flat_boundary += (cloth.panel_coordinates[a] - cloth.panel_coordinates[b]).norm();
        }
        measures.push_back(
            {panel.name, std::abs(area - flat_area) / flat_area, std::abs(boundary - flat_boundary) / flat_boundary});
    }
    return measures;
}

std::vector<OpenSeam> open_seams(const Cloth& cloth, const std::vector<Vec3>& positions)
{
    std::vector<OpenSeam> open;
    for (int s = 0; s < int(cloth.seams.size()); ++s) {
        const Seam& seam = cloth.seams[s];
        OpenSeam widest{.seam = s};
        for (int k = seam.first_pair; k < seam.first_pair + seam.pair_count; ++k) {
            const double gap = (positions[cloth.seam_pairs[k][0]] - positions[cloth.seam_pairs[k][1]]).norm();
            if (gap > widest.gap) widest = {s, k, gap};
        }
        if (widest.gap > 0) open.push_back(widest);
    }
    std::stable_sort(open.begin(), open.end(), [](const OpenSeam& a, const OpenSeam& b) { return a.gap > b.gap; });
    return open;
}

std::array<std::string, 2> seam_sides(const Cloth& cloth, int seam)
{
    const auto side = [&](int index) {
        const OutlineSamples& edge = cloth.outline[index];
        return cloth.panels[edge.panel].name + "[" + std::to_string(edge.edge) + "]";
    };
    return {side(cloth.seams[seam].side_a), side(cloth.seams[seam].side_b)};
}

double measure_seam_gap(const Cloth& cloth, const std::vector<Vec3>& positions)
{
    double gap = 0;
    for (const auto& [a, b] : cloth.seam_pairs) gap = std::max(gap, (positions[a] - positions[b]).norm());
    return gap;
}

std::vector<std::array<Vec2, 3>> rest_corners(const Cloth& cloth)
{
    std::vector<std::array<Vec2, 3>> corners;
    corners.reserve(cloth.faces.size());
    const auto single = [&](int vertex) -> Vec2 {
        return cloth.panel_coordinates[vertex].cast<float>().cast<double>();
    };
    for (const Face& f : outward_faces(cloth)) corners.push_back({single(f[0]), single(f[1]), single(f[2])});
    return corners;
}

std::vector<int> face_panels(const Cloth& cloth)
{
    std::vector<int> panels;
    for (int p = 0; p < int(cloth.panels.size()); ++p)
        panels.insert(panels.end(), std::size_t(cloth.panels[p].face_count), p);
    return panels;
}

std::vector<std::array<double, 3>> rest_edge_lengths(const Cloth& cloth)
{
    std::vector<std::array<double, 3>> lengths;
    lengths.reserve(cloth.faces.size());
    const auto& u = cloth.panel_coordinates;
    for (const Face& f : outward_faces(cloth))
        lengths.push_back({(u[f[1]] - u[f[0]]).norm(), (u[f[2]] - u[f[1]]).norm(), (u[f[0]] - u[f[2]]).norm()});
    return lengths;
}

}  // namespace selvage
