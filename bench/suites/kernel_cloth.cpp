#include "bench/suites/kernel_cloth.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "bench/harness/scatter.hpp"
#include "host/garment/sheet.hpp"
#include "host/mesh/body_tessellation.hpp"
#include "host/model/body.hpp"
#include "host/model/cloth_model.hpp"
#include "host/model/prolongation.hpp"
#include "host/solver/contact/anchors.hpp"
#include "host/solver/state/springs.hpp"
#include "host/solver/terms/cloth_state.hpp"
#include "host/solver/terms/face_air.hpp"
#include "host/solver/terms/terms.hpp"
#include "host/solver/terms/unit_strengths.hpp"

namespace selvage {
namespace {

constexpr double dome_radius = 1;        // [m]
constexpr int dome_level = 6;            // 20 * 4^6 triangles
constexpr double contact_margin = 0.03;  // as in a run [m]
constexpr int coarsest_vertices = 300;

Params bench_params()
{
    Params params = unit_strengths();
    params.gravity.acceleration_x = 0.1;
    params.gravity.acceleration_y = -0.2;
    params.gravity.acceleration_z = -9.81;
    params.seam.stiffness = 400;
    params.body_contact.stiffness = 150;
    return params;
}

FabricTable one_fabric()
{
    Fabric fabric;
    fabric.name = "cotton";
    fabric.stretch_coupling = 60;
    fabric.hysteresis_weft = fabric.hysteresis_warp = 1e-3;
    return {{fabric.name, fabric}};
}

Cloth square_sheet(int resolution)
{
    SheetScene sheet;
    sheet.resolution = resolution;
    sheet.mesh_family = MeshFamily::alternating;
    sheet.fabric = "cotton";
    return make_sheet(sheet, "", "sheet[0]");
}

void add_stitches(Cloth& cloth, int resolution)
{
    for (int v = 0; v + 2 * resolution + 2 < int(cloth.positions.size()); v += 20)
        if (v % resolution + 2 < resolution) cloth.seam_pairs.push_back({v, v + 2 * resolution + 2});
}

}  // namespace

KernelCloth::KernelCloth(int vertex_count) : params(bench_params())
{
    const int resolution = std::max(4, int(std::lround(std::sqrt(double(vertex_count)))));
    Cloth cloth = square_sheet(resolution);
    add_stitches(cloth, resolution);
    const FabricTable fabrics = one_fabric();
    Topology topology = make_topology(cloth, false);
    add_springs(topology, cloth, fabrics, springs_of(params));
    std::vector<Vec3> positions, velocities;
    lay_on_dome(cloth, positions, velocities);
    state = make_state(topology, cloth, fabrics, params, positions, velocities);
    find_face_air(state);

    make_bodies();
    contact = std::make_shared<ClothBodyContact>(*query, bodies, topology, cloth, fabrics, params.body_contact.gap,
                                                 contact_margin, true);
    contact->update(state);
    load_friction();
    put_pairs();
    keep(state, start_);

    pattern = make_pattern(state);
    connect_levels(cloth, topology, resolution);
    block_jacobi = make_linear_solver_double(state, {Preconditioner::block_jacobi}, {});
    multigrid = make_linear_solver_double(state, {Preconditioner::multigrid}, prolongations);
}

void KernelCloth::make_bodies()
{
    Body dome;
    dome.name = "dome";
    dome.mesh = sphere_mesh(Vec3::Zero(), dome_radius, dome_level);
    dome.radius = dome_radius;
    bodies.push_back(dome);
    const Vec3 half = Vec3::Constant(1.5 * dome_radius);
    query = std::make_unique<BodyQuery>(bodies, Box(-half, half));
}

// Rolls the sheet onto the dome, keeping distances from its middle, with waves and scatter inside the contact gap.
void KernelCloth::lay_on_dome(const Cloth& cloth, std::vector<Vec3>& positions, std::vector<Vec3>& velocities) const
{
    const double spacing = 1 / std::sqrt(double(cloth.positions.size()));
    for (std::size_t v = 0; v < cloth.panel_coordinates.size(); ++v) {
        const Vec2 crumple(scatter(3 * v), scatter(3 * v + 1));
        const Vec2 flat = cloth.panel_coordinates[v] + 0.02 * spacing * crumple;
        const double reach = flat.norm(), angle = reach / dome_radius;
        const Vec2 across = reach > 0 ? Vec2(std::sin(angle) / reach * flat) : flat;
        const Vec3 outward(across.x(), across.y(), std::cos(angle));
        const double wave = 0.3 * std::sin(40 * flat.x()) * std::cos(37 * flat.y()) + 0.1 * scatter(3 * v + 2);
        positions.push_back((dome_radius + params.body_contact.gap * (0.5 + wave)) * outward);
        velocities.push_back(0.01 * Vec3(outward.z(), wave, -outward.x()));
    }
}

// Halves the resolution until the coarsest level is small, as a run does.
void KernelCloth::connect_levels(const Cloth& cloth, const Topology& topology, int resolution)
{
    Cloth finer = cloth;
    Topology finer_topology = topology;
    while (int(finer.positions.size()) > coarsest_vertices) {
        resolution = (resolution + 1) / 2;
        Cloth coarse = square_sheet(resolution);
        Topology coarse_topology = make_topology(coarse, false);
        prolongations.push_back(
            particle_prolongation(make_prolongation(coarse, finer), coarse_topology, finer_topology));
        finer = std::move(coarse);
        finer_topology = std::move(coarse_topology);
    }
}

// Sets the limits from the normal forces and draws the anchors away, up to twice the way at which a vertex slips.
void KernelCloth::load_friction()
{
    settle_friction(state, params);
    const int vs = state.size.vertex_stride;
    for (int v = 0; v < state.size.vertex_count; ++v)
        for (int c = 0; c < 3; ++c)
            state.friction_anchor[c * vs + v] +=
                1.5 * params.friction.stick_distance * scatter(std::uint64_t(3 * v + c));
}

// Pairs as a sheet that is folded in two has them, each within its contact distance: corners of faces and other faces.
void KernelCloth::put_pairs()
{
    const int count = state.size.face_count, fs = state.size.face_stride, n = state.size.vertex_count;
    state.set_body_points(0);
    state.set_pairs(count);
    const int ps = state.size.pair_stride, vs = state.size.vertex_stride;
    std::vector<std::array<int, 4>> corners(static_cast<std::size_t>(count));
    for (int p = 0; p < count; ++p) {
        const int other = count - 1 - p;
        corners[p] = {state.face_vertex[p], state.face_vertex[other], state.face_vertex[fs + other],
                      state.face_vertex[2 * fs + other]};
        if (corners[p][0] == corners[p][1] || corners[p][0] == corners[p][2] || corners[p][0] == corners[p][3])
            corners[p][0] = (corners[p][0] + n / 2) % n;
        for (int i = 0; i < 4; ++i) {
            state.pair_vertex[i * ps + p] = corners[p][i];
            state.pair_held_weight[i * ps + p] = i == 0 ? 1 : -1.0 / 3;
        }
        state.pair_area[p] = 1e-6;
        state.pair_gap[p] = 4 * dome_radius;  // more than any distance on the dome
        state.pair_held_normal[2 * ps + p] = 1;
        state.pair_limit[p] = 1e-3;
    }
    std::vector<int> begin(std::size_t(n) + 1);
    for (const auto& pair : corners)
        for (int v : pair) ++begin[v + 1];
    std::partial_sum(begin.begin(), begin.end(), begin.begin());
    for (int v = 0; v < n; ++v) {
        state.pair_slots[v] = begin[v];
        state.pair_slots[vs + v] = begin[v + 1];
    }
    for (int p = 0; p < count; ++p)
        for (int i = 0; i < 4; ++i) state.pair_slot[begin[corners[p][i]]++] = 4 * p + i;
}

void KernelCloth::reset()
{
    restore(state, start_);
    contact->update(state);
}

}  // namespace selvage
