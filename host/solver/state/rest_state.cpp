#include "host/solver/state/rest_state.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "host/model/cloth_model.hpp"
#include "host/parallel/launch.hpp"
#include "host/solver/state/materials.hpp"
#include "host/solver/state/planes.hpp"
#include "host/solver/state/springs.hpp"

namespace selvage {
namespace {

double rest_area(const Cloth& cloth, int face)
{
    const Face& f = cloth.faces[face];
    const Vec2 a = cloth.panel_coordinates[f[1]] - cloth.panel_coordinates[f[0]];
    const Vec2 b = cloth.panel_coordinates[f[2]] - cloth.panel_coordinates[f[0]];
    return 0.5 * (a.x() * b.y() - a.y() * b.x());
}

// Bends the cloth across the edge: the rigidity along the edge's normal in the panel, weighted by its components.
double rigidity_across(const Vec2& edge, const Fabric& fabric)
{
    const double u = edge.y() * edge.y(), v = edge.x() * edge.x();
    return (fabric.bending_weft * u + fabric.bending_warp * v) / (u + v);
}

std::vector<int> panel_of_faces(const Cloth& cloth)
{
    std::vector<int> panel(cloth.faces.size());
    for (int p = 0; p < int(cloth.panels.size()); ++p)
        std::fill_n(panel.begin() + cloth.panels[p].first_face, cloth.panels[p].face_count, p);
    return panel;
}

// Lists, vertex by vertex, the elements and corners that touch it.
template <std::size_t Corners>
void fill_slots(const std::vector<std::array<int, Corners>>& elements, int vertex_count, int vertex_stride,
                std::vector<int>& slots, std::vector<int>& slot)
{
    if (slots.empty()) return;
    std::vector<int> begin(std::size_t(vertex_count) + 1, 0);
    for (const auto& element : elements)
        for (int v : element) ++begin[std::size_t(v) + 1];
    std::partial_sum(begin.begin(), begin.end(), begin.begin());
    for (int v = 0; v < vertex_count; ++v) {
        slots[v] = begin[v];
        slots[vertex_stride + v] = begin[std::size_t(v) + 1];
    }
    for (int e = 0; e < int(elements.size()); ++e)
        for (int k = 0; k < int(Corners); ++k) slot[begin[elements[e][k]]++] = 4 * e + k;
}

struct PanelFabrics {
    std::vector<const Fabric*> fabric;  ///< Per panel.
    std::vector<int> material;          ///< Row of the material table, per panel.
};

PanelFabrics panel_fabrics(const Cloth& cloth, const FabricTable& fabrics)
{
    PanelFabrics table;
    for (const ClothPanel& panel : cloth.panels) {
        const auto it = fabrics.find(panel.fabric);
        table.fabric.push_back(&it->second);
        table.material.push_back(int(std::distance(fabrics.begin(), it)));
    }
    return table;
}

void fill_faces(State& state, const Topology& topology, const Cloth& cloth, const PanelFabrics& fabrics)
{
    const int fs = state.size.face_stride;
    const std::vector<int> panel = panel_of_faces(cloth);
    std::fill(state.contact_hardness.begin(), state.contact_hardness.end(), real(1));
    for (int f = 0; f < int(topology.faces.size()); ++f) {
        const Fabric& fabric = *fabrics.fabric[panel[f]];
        const double area = rest_area(cloth, f);
        for (int particle : topology.faces[f]) {
            state.mass[particle] += fabric.areal_density * area / 3;
            if (!state.drag.empty()) state.drag[particle] += fabric.damping * fabric.areal_density * area / 3;
            if (!state.contact_area.empty()) state.contact_area[particle] += area / 3;
        }
        if (state.face_vertex.empty()) continue;
        for (int k = 0; k < 3; ++k) state.face_vertex[k * fs + f] = topology.faces[f][k];
        if (state.face_weights.empty()) continue;  // no membrane
        state.face_material[f] = fabrics.material[panel[f]];
        state.face_area[f] = area;
        const std::array<double, 4> weights = face_rest_weights(cloth, f);
        for (int k = 0; k < 4; ++k) state.face_weights[k * fs + f] = weights[k];
    }
}

// A hinge's edge in the rest plane of one of its faces.
Vec2 rest_edge(const Topology& topology, const Cloth& cloth, int hinge, int side)
{
    const int face = topology.hinge_faces[hinge][side];
    const int opposite = topology.hinges[hinge][2 + side];
    int k = 0;
    while (topology.faces[face][k] != opposite) ++k;
    const Face& f = cloth.faces[face];
    return cloth.panel_coordinates[f[(k + 2) % 3]] - cloth.panel_coordinates[f[(k + 1) % 3]];
}

void fill_hinges(State& state, const Topology& topology, const Cloth& cloth, const PanelFabrics& fabrics)
{
    if (state.hinge_vertex.empty()) return;
    const int hs = state.size.hinge_stride;
    const std::vector<int> panel = panel_of_faces(cloth);
    for (int h = 0; h < int(topology.hinges.size()); ++h) {
        double area = 0, rigidity = 0, squared_length = 0;
        for (int side = 0; side < 2; ++side) {
            const int face = topology.hinge_faces[h][side];
            const Vec2 edge = rest_edge(topology, cloth, h, side);
            area += rest_area(cloth, face);
            rigidity += 0.5 * rigidity_across(edge, *fabrics.fabric[panel[face]]);
            squared_length += 0.5 * edge.squaredNorm();
        }
        for (int k = 0; k < 4; ++k) state.hinge_vertex[k * hs + h] = topology.hinges[h][k];
        if (!state.hinge_rigidity.empty()) state.hinge_rigidity[h] = rigidity * squared_length / area;
    }
}

}  // namespace

std::array<double, 4> face_rest_weights(const Cloth& cloth, int face)
{
    const Face& f = cloth.faces[face];
    const Vec2 a = cloth.panel_coordinates[f[1]] - cloth.panel_coordinates[f[0]];
    const Vec2 b = cloth.panel_coordinates[f[2]] - cloth.panel_coordinates[f[0]];
    const double det = a.x() * b.y() - a.y() * b.x();
    return {b.y() / det, -a.y() / det, -b.x() / det, a.x() / det};
}

void place_particles(State& state, const Topology& topology, const Cloth& cloth, const FabricTable& fabrics,
                     const std::vector<Vec3>& positions, const std::vector<Vec3>& velocities)
{
    const Planes x = vertex_planes(state.size, state.pos), u = vertex_planes(state.size, state.vel);
    const PanelFabrics table = panel_fabrics(cloth, fabrics);
    std::fill(state.pos.begin(), state.pos.end(), 0);
    std::fill(state.vel.begin(), state.vel.end(), 0);
    // Each cloth vertex carries its own share of its particle's mass.
    std::vector<double> share(positions.size());
    const std::vector<int> panel = panel_of_faces(cloth);
    for (int f = 0; f < int(cloth.faces.size()); ++f)
        for (int v : cloth.faces[f]) share[v] += table.fabric[panel[f]]->areal_density * rest_area(cloth, f) / 3;
    for (int v = 0; v < int(positions.size()); ++v) {
        const int p = topology.particle_of[v];
        const double weight = share[v] / state.mass[p];
        x.set(p, x(p) + weight * positions[v]);
        if (!velocities.empty()) u.set(p, u(p) + weight * velocities[v]);
    }
    for (int p = 0; p < x.count; ++p) state.inv_mass[p] = 1 / state.mass[p];
    for (int v : cloth.pinned) {
        const int p = topology.particle_of[v];
        state.inv_mass[p] = 0;
        x.set(p, positions[v]);
        u.set(p, Vec3::Zero());
    }
}

void fill_state(State& state, const Topology& topology, const Cloth& cloth, const FabricTable& fabrics,
                const std::vector<Vec3>& positions, const std::vector<Vec3>& velocities)
{
    const PanelFabrics table = panel_fabrics(cloth, fabrics);
    fill_materials(state, fabrics);
    fill_faces(state, topology, cloth, table);
    fill_hinges(state, topology, cloth, table);
    fill_springs(state, topology);
    for (int s = 0; s < int(topology.stitches.size()) && !state.stitch_vertex.empty(); ++s)
        for (int k = 0; k < 2; ++k) state.stitch_vertex[k * state.size.stitch_stride + s] = topology.stitches[s][k];

    const int vs = state.size.vertex_stride, n = state.size.vertex_count;
    fill_slots(topology.faces, n, vs, state.face_slots, state.face_slot);
    fill_slots(topology.hinges, n, vs, state.hinge_slots, state.hinge_slot);
    fill_slots(topology.stitches, n, vs, state.stitch_slots, state.stitch_slot);
    std::vector<std::array<int, 2>> spring_ends;
    for (const Spring& spring : topology.springs) spring_ends.push_back(spring.vertex);
    fill_slots(spring_ends, n, vs, state.spring_slots, state.spring_slot);
    place_particles(state, topology, cloth, fabrics, positions, velocities);
}

std::vector<Vec3> cloth_vectors(const Topology& topology, const mesh_sizes& size, const std::vector<real>& field)
{
    std::vector<Vec3> vectors(topology.particle_of.size());
    const ConstPlanes planes = vertex_planes(size, field);
    for_each_item(int(vectors.size()), [planes, to = vectors.data(), particle = topology.particle_of.data()](int v) {
        to[v] = planes(particle[v]);
    });
    return vectors;
}

}  // namespace selvage
