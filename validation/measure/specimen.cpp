#include "validation/measure/specimen.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

#include "host/mesh/sheet_families.hpp"
#include "host/solver/state/planes.hpp"
#include "host/solver/terms/cloth_state.hpp"
#include "validation/measure/direct_solver.hpp"

namespace selvage {
namespace {

std::unique_ptr<LinearSolver> make_solver(const State& state, Solve solve)
{
    if (solve == Solve::iterative) return make_linear_solver_double(state, {Preconditioner::block_jacobi, 40000}, {});
    return make_direct_solver(solve == Solve::direct_in_plane);
}

// Returns the vertices on the left edge, from the bottom up.
std::vector<int> left_rim(const Cloth& cloth)
{
    std::vector<int> rim;
    for (int v = 0; v < int(cloth.positions.size()); ++v)
        if (cloth.positions[v].x() < 1e-9) rim.push_back(v);
    std::sort(rim.begin(), rim.end(), [&](int a, int b) { return cloth.positions[a].y() < cloth.positions[b].y(); });
    return rim;
}

}  // namespace

Fabric isotropic_fabric(double stiffness, double rigidity, double poisson, double areal_density)
{
    Fabric fabric;
    fabric.name = specimen_fabric;
    fabric.areal_density = areal_density;
    fabric.stretch_weft = fabric.stretch_warp = stiffness / (1 - poisson * poisson);
    fabric.stretch_coupling = poisson * fabric.stretch_weft;
    fabric.shear = stiffness / (2 * (1 + poisson));
    fabric.bending_weft = fabric.bending_warp = rigidity;
    fabric.bending_coupling = poisson * rigidity;
    fabric.bending_twist = 2 * (1 - poisson) * rigidity;
    fabric.damping = 0;
    return fabric;
}

Specimen::Specimen(const Cloth& cloth, const Fabric& fabric, const Params& params, Solve solve)
    : system_(make_state(make_topology(cloth, true), cloth, {{specimen_fabric, fabric}}, params, cloth.positions, {}),
              params, profile_),
      linear_(make_solver(system_.state(), solve)), newton_(system_, *linear_)
{
}

Vec3 Specimen::position(int vertex) const { return vertex_planes(state().size, state().pos)(vertex); }

void Specimen::place(int vertex, const Vec3& position)
{
    vertex_planes(state().size, state().pos).set(vertex, position);
}

Vec3 Specimen::holding_force(int vertex) const { return -vertex_planes(state().size, state().force)(vertex); }

void Specimen::balance(double tolerance)
{
    NewtonOptions options;
    options.max_iterations = 20;
    options.tolerance = 1e-4;
    options.linear_tolerance = 1e-6;
    options.full_stiffness = true;
    double residual = system_.residual(), dt = 0.01;
    for (int step = 0; step < 60 && residual > tolerance; ++step) {
        std::fill(state().vel.begin(), state().vel.end(), 0);
        dt *= implicit_euler_step(newton_, dt, options).converged ? 2 : 0.5;
        residual = system_.residual();
        if (residual > 0.3) continue;
        NewtonOptions last = options;
        last.tolerance = tolerance;
        residual = newton_.relax(last).residual;
    }
    system_.evaluate_forces(false);  // which hold it
    if (!(residual <= tolerance))
        throw std::runtime_error(fmt::format("no equilibrium: residual {:.2e}, wanted {:.0e}", residual, tolerance));
}

void Specimen::balance_from_soft(double tolerance)
{
    const double full = params().membrane.scale;
    for (const double part : {1e-3, 3e-2, 1.0}) {
        params().membrane.scale = part * full;
        balance(part < 1 ? 1e-3 : tolerance);
    }
}

ClothPanel one_panel(const Cloth& cloth)
{
    ClothPanel panel;
    panel.name = "sheet";
    panel.fabric = specimen_fabric;
    panel.vertex_count = int(cloth.positions.size());
    panel.face_count = int(cloth.faces.size());
    return panel;
}

Cloth flat_rectangle(MeshFamily family, double width, double height, int columns)
{
    SheetMesh mesh = rectangle_mesh(family, width, height, columns);
    Cloth cloth;
    for (Vec2& point : mesh.points) {
        point.x() += 0.5 * width;
        cloth.positions.emplace_back(point.x(), point.y(), 0);
    }
    cloth.panel_coordinates = std::move(mesh.points);
    cloth.faces = std::move(mesh.faces);
    cloth.panels = {one_panel(cloth)};
    return cloth;
}

Cloth clamped_strip(MeshFamily family, double length, double width, int segments)
{
    Cloth cloth = flat_rectangle(family, length, width, segments + 1);
    const double step = length / segments;
    const std::vector<int> rim = left_rim(cloth);
    const int first = int(cloth.positions.size());
    for (int i = 0; i < int(rim.size()); ++i) {
        const Vec3 flap = cloth.positions[rim[i]] - Vec3(step, 0, 0);
        cloth.positions.push_back(flap);
        cloth.panel_coordinates.emplace_back(flap.x(), flap.y());
        cloth.pinned.push_back(rim[i]);
        if (i == 0) continue;
        cloth.faces.push_back({first + i - 1, rim[i - 1], rim[i]});
        cloth.faces.push_back({first + i - 1, rim[i], first + i});
    }
    for (int i = 0; i < int(rim.size()); ++i) cloth.pinned.push_back(first + i);
    std::sort(cloth.pinned.begin(), cloth.pinned.end());
    cloth.panels = {one_panel(cloth)};
    return cloth;
}

Params heavy_plate(const Vec3& gravity)
{
    Params params;
    params.membrane.scale = 1;
    params.plate.scale = 1;
    params.gravity.acceleration_x = gravity.x();
    params.gravity.acceleration_y = gravity.y();
    params.gravity.acceleration_z = gravity.z();
    return params;
}

}  // namespace selvage
