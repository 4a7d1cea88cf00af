#pragma once
#include <random>
#include <vector>

#include "host/collision/ccd.hpp"
#include "host/model/cloth_model.hpp"
#include "host/solver/state/planes.hpp"
#include "host/solver/state/springs.hpp"
#include "host/solver/state/topology.hpp"
#include "host/solver/terms/cloth_state.hpp"
#include "host/solver/terms/face_air.hpp"
#include "host/solver/terms/terms.hpp"

namespace selvage {

/// A flat grid of columns x rows vertices, 0.1 m apart, with alternating diagonals, in one panel.
inline Cloth grid_cloth(int columns, int rows, double spacing = 0.1)
{
    Cloth cloth;
    for (int r = 0; r < rows; ++r)
        for (int c = 0; c < columns; ++c) {
            cloth.panel_coordinates.push_back(Vec2(c * spacing, r * spacing));
            cloth.positions.push_back(Vec3(c * spacing, r * spacing, 0));
        }
    for (int r = 0; r + 1 < rows; ++r)
        for (int c = 0; c + 1 < columns; ++c) {
            const int v = r * columns + c;
            const int w = v + columns;
            if ((r + c) % 2) {
                cloth.faces.push_back({v, v + 1, w + 1});
                cloth.faces.push_back({v, w + 1, w});
            } else {
                cloth.faces.push_back({v, v + 1, w});
                cloth.faces.push_back({v + 1, w + 1, w});
            }
        }
    ClothPanel panel;
    panel.name = "sheet";
    panel.fabric = "test";
    panel.vertex_count = columns * rows;
    panel.face_count = int(cloth.faces.size());
    panel.rest_area = spacing * spacing * (columns - 1) * (rows - 1);
    cloth.panels.push_back(panel);
    return cloth;
}

/// An orthotropic fabric whose properties are all of order one, so that no term is negligible in a test.
inline FabricTable test_fabrics()
{
    Fabric fabric;
    fabric.name = "test";
    fabric.areal_density = 2;
    fabric.stretch_weft = 3;
    fabric.stretch_warp = 2;
    fabric.stretch_coupling = 0.5;
    fabric.shear = 0.7;
    fabric.bending_weft = 0.02;
    fabric.bending_warp = 0.01;
    fabric.hysteresis_weft = 0.3;
    fabric.hysteresis_warp = 0.2;
    return {{"test", fabric}};
}

/// The same with curves of every form and over-elongation limits, so that a crumpled sheet reaches many ranges.
inline FabricTable curved_fabrics()
{
    FabricTable fabrics = test_fabrics();
    Fabric& fabric = fabrics.at("test");
    fabric.stretch_weft_curve = piecewise_curve({{0.05, 0.2}, {0.2, 1}, {0.5, 4}});
    fabric.stretch_warp_curve = smooth_curve({{0.1, 0.2}, {0.3, 0.9}, {0.4, 2}});
    fabric.shear_curve = cubic_curve(0.7, -0.2, 3);
    fabric.stretch_limit = 0.35;
    fabric.shear_limit = 0.4;
    return fabrics;
}

/// Returns the positions of the corners of a pair [m].
inline PairCorners pair_corners(const State& state, int pair)
{
    PairCorners x;
    for (int i = 0; i < 4; ++i) {
        const int v = state.pair_vertex[i * state.size.pair_stride + pair];
        const std::vector<real>& from = v >= 0 ? state.pos : state.body_point;
        const int stride = v >= 0 ? state.size.vertex_stride : state.size.body_point_stride, k = v >= 0 ? v : -1 - v;
        x[i] = ConstPlanes{from.data(), stride}(k);
    }
    return x;
}

/// Fills the list of pairs around each vertex, which contact does otherwise.
inline void list_pair_slots(State& state)
{
    int count = 0;
    for (int v = 0; v < state.size.vertex_count; ++v) {
        state.pair_slots[v] = count;
        for (int p = 0; p < state.size.pair_count; ++p)
            for (int i = 0; i < 4; ++i)
                if (state.pair_vertex[i * state.size.pair_stride + p] == v) state.pair_slot[count++] = 4 * p + i;
        state.pair_slots[state.size.vertex_stride + v] = count;
    }
}

/// Adds pairs in contact to a grid of 4 x 4 vertices: a vertex and a face, two edges, and, if `touches_body`, a face
/// and an edge with a body. The contact gap of each pair is near its distance. Half of the pairs stick and half slide.
inline void add_contacts(State& state, const Params& params, bool touches_body, std::mt19937& random)
{
    std::uniform_real_distribution<real> uniform(-1, 1);
    const std::vector<std::array<int, 5>> pairs{
        {5, 0, 2, 9, 0}, {5, 10, 6, 9, 1}, {-1, 6, 7, 11, 0}, {8, 13, -2, -3, 1}};
    const int count = touches_body ? 4 : 2;
    state.set_pairs(count);
    state.set_body_points(touches_body ? 3 : 0);
    const int ps = state.size.pair_stride, bs = state.size.body_point_stride;
    // The first body point is near the face 6 7 11; the other two form an edge across the edge 8 13.
    const double across[3][3] = {{0.26, 0.13, 0.03}, {0.02, 0.22, -0.05}, {0.09, 0.3, 0.07}};
    for (int k = 0; k < state.size.body_point_count; ++k)
        for (int c = 0; c < 3; ++c) state.body_point[c * bs + k] = across[k][c];
    for (int p = 0; p < count; ++p) {
        for (int i = 0; i < 4; ++i) state.pair_vertex[i * ps + p] = pairs[p][i];
        state.pair_edges[p] = pairs[p][4];
        const PairCorners x = pair_corners(state, p);
        state.pair_area[p] = 1 + 0.5 * uniform(random);
        state.pair_gap[p] = pair_distance(x, pairs[p][4]) / (0.55 + 0.3 * uniform(random));
        if (!state.wanted[std::size_t(Field::pair_limit)]) continue;
        const pair_weights held = pairs[p][4] ? face_weights(0.6, 0.3) : face_weights(0.2, 0.4);
        Vec3 r = Vec3::Zero(), aside(uniform(random), uniform(random), uniform(random));
        for (int i = 0; i < 4; ++i) r += held.w[i] * x[i];
        const Vec3 n = r.normalized(), way = (aside - n.dot(aside) * n).normalized();
        for (int i = 0; i < 4; ++i) state.pair_held_weight[i * ps + p] = held.w[i];
        for (int c = 0; c < 3; ++c) {
            state.pair_held_normal[c * ps + p] = n[c];
            state.pair_bristle[c * ps + p] = (p % 2 ? 0.6 : 1.7) * params.cloth_friction.stick_distance * way[c];
        }
        state.pair_friction[p] = 0.4;
        state.pair_limit[p] = 1 + 0.5 * uniform(random);
    }
    list_pair_slots(state);
}

/// The grid with random displacements of 40 % of its spacing, random velocities, contacts near the barrier's gap,
/// slipping and sticking anchors, stitches between its first and last vertices, and pairs in contact.
/// @param touches_body  some of the pairs are with a body
inline State crumpled_state(const Params& params, unsigned seed = 7, bool touches_body = true)
{
    Cloth cloth = grid_cloth(4, 4);
    cloth.seam_pairs = {{0, 15}, {1, 2}};
    Topology topology = make_topology(cloth, false);
    add_springs(topology, cloth, curved_fabrics(), springs_of(params));
    State state = make_state(topology, cloth, curved_fabrics(), params, cloth.positions, {});
    std::mt19937 random(seed);
    std::uniform_real_distribution<real> uniform(-1, 1);
    const Planes pos = vertex_planes(state.size, state.pos);
    for (int v = 0; v < pos.count; ++v) {
        Vec3 normal(uniform(random), uniform(random), uniform(random)), x = pos(v), velocity, anchor;
        normal.normalize();
        for (int c = 0; c < 3; ++c) {
            x[c] += 0.04 * uniform(random);
            velocity[c] = uniform(random);
            anchor[c] = x[c] + params.friction.stick_distance * uniform(random);
        }
        pos.set(v, x);
        vertex_planes(state.size, state.vel).set(v, velocity);
        vertex_planes(state.size, state.contact_normal).set(v, normal);
        vertex_planes(state.size, state.friction_anchor).set(v, anchor);
        state.contact_offset[v] = normal.dot(x) - params.body_contact.gap * (0.6 + 0.5 * uniform(random));
        state.friction_limit[v] = 1 + uniform(random);
    }
    for (int h = 0; h < state.size.hinge_count; ++h) state.hinge_rest_sine[h] = 0.2 * uniform(random);
    for (int h = 0; h < state.size.hinge_count; ++h) state.hinge_anchor[h] = 0.5 * uniform(random);
    if (!state.face_air.empty()) find_face_air(state);
    if (state.wanted[std::size_t(Field::pair_vertex)]) add_contacts(state, params, touches_body, random);
    return state;
}

}  // namespace selvage
