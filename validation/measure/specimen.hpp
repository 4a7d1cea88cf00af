#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "host/solver/stepping/newton.hpp"
#include "host/solver/terms/cloth_state.hpp"
#include "io/choices.hpp"

namespace selvage {

/// The name of a specimen's only fabric.
inline constexpr const char* specimen_fabric = "test";

/// A fabric that is an isotropic plate and an isotropic membrane.
/// @param stiffness  Y = E h [N/m]
/// @param rigidity   D [N m]
/// @param poisson    of both
Fabric isotropic_fabric(double stiffness, double rigidity, double poisson, double areal_density);

enum class Solve { direct, direct_in_plane, iterative };

/// A small cloth with the forces and the Newton solver that a run would have.
class Specimen {
public:
    /// @param cloth   its panel's fabric is specimen_fabric
    /// @param params  strengths of the terms
    Specimen(const Cloth& cloth, const Fabric& fabric, const Params& params, Solve solve = Solve::direct);

    System& system() { return system_; }
    State& state() { return system_.state(); }
    const State& state() const { return system_.state(); }
    Params& params() { return system_.params(); }

    Vec3 position(int vertex) const;
    void place(int vertex, const Vec3& position);
    /// Returns the gradient of the energy at a vertex: the external force that holds it in equilibrium [N]. Call after
    /// balance().
    Vec3 holding_force(int vertex) const;

    /// Finds the static equilibrium by implicit steps from rest, each longer than the one before, and then by Newton's
    /// method on the energy.
    /// @param tolerance  residual to reach, relative to the weight
    /// @throws std::runtime_error if it is not reached
    void balance(double tolerance);
    /// The same, but the membrane's stiffness is increased from a small value to its own in several stages, because a
    /// stiff membrane converges slowly from a distant start.
    void balance_from_soft(double tolerance);

private:
    Profile profile_;
    System system_;
    std::unique_ptr<LinearSolver> linear_;
    Newton newton_;
};

/// Returns a panel of specimen_fabric that covers the whole cloth.
ClothPanel one_panel(const Cloth& cloth);

/// A rectangle of one of rectangle_families(), lying in the plane z = 0 from (0, -height/2) to (width, height/2).
Cloth flat_rectangle(MeshFamily family, double width, double height, int columns);

/// A strip from x = 0 to `length` that is clamped at x <= 0 by a rigid flap: two held columns of vertices.
/// @param segments  along the length
Cloth clamped_strip(MeshFamily family, double length, double width, int segments);

/// Parameters with gravity, the membrane and plate bending.
Params heavy_plate(const Vec3& gravity);

}  // namespace selvage
