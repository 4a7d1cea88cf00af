#pragma once
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

#include "host/model/cloth.hpp"
#include "host/solver/state/state.hpp"
#include "host/solver/state/topology.hpp"

namespace selvage {

/// Where the blocks of the stiffness matrix stand, and where each element adds to them.
struct BlockPattern {
    std::vector<int> row_begin;  ///< Particle count + 1.
    std::vector<int> column;     ///< Sorted within a row.
    /// Per entry of the kind's gather list and corner: the block within the row.
#define PLACES(kind, corners) std::vector<std::uint16_t> kind##_place;
    ELEMENT_KINDS(PLACES)
#undef PLACES

    int rows() const { return int(row_begin.size()) - 1; }
    int blocks() const { return int(column.size()); }
    /// Returns the bytes of all places.
    std::size_t place_bytes() const
    {
        std::size_t places = 0;
#define COUNT_PLACES(kind, corners) places += kind##_place.size();
        ELEMENT_KINDS(COUNT_PLACES)
#undef COUNT_PLACES
        return places * sizeof(std::uint16_t);
    }
};

/// Finds the pattern from the gather lists of an allocated and filled state.
BlockPattern make_pattern(const State& state);

enum class Preconditioner {
    block_jacobi,
    multigrid,
    direct  ///< A sparse Cholesky factor of the whole matrix, for small cloth; plates and contacts add to it.
};

struct LinearOptions {
    Preconditioner preconditioner = Preconditioner::block_jacobi;
    int max_iterations = 600;
};

/// When a solve may end. The residual's norm is ruled by stiff directions: once these are solved it is small, whatever
/// is left of the soft ones. The error in the energy norm, |x - A^-1 b|_A, counts both by what they are worth.
struct LinearGoal {
    double residual = 0.05;  ///< |b - A x| / |b| [1]; where energy_part is above 0 it does not count.
    double energy_part = 0;  ///< Error in the energy norm over that norm of the solution [1]; 0: not asked for.
    double energy_left = 0;  ///< Or the square of that error [J], whichever is met first.
    int at_most = std::numeric_limits<int>::max();  ///< Iterations, at most those of the options.
};

struct LinearResult {
    int iterations = 0;
    double relative_residual = 1;     ///< |b - A x| / |b|.
    double energy_left = 0;           ///< Where energy_part was asked for: about the square of the error left [J].
    bool negative_curvature = false;  ///< A direction p with p.Ap <= 0 was met; x is what stood before it.
};

/// The parts of one iteration, to be measured one by one.
enum class LinearOperation { product, precondition, dot, update };

/// What an assembled matrix is for.
enum class MatrixUse {
    products,  ///< No preconditioner is made.
    solves,    ///< The preconditioner is made of this matrix alone.
    likewise,  ///< Its coarse matrices may be those of the matrix before, which differs little, as long as they serve.
};

/// Preconditioned conjugate gradients on 3x3 blocks (Baraff and Witkin 1998).
class LinearSolver {
public:
    virtual ~LinearSolver() = default;
    /// Gathers the stiffness slots of the state; adds inertia * mass to the diagonal. @param inertia 1/dt^2 [1/s^2]
    /// A plate's hinge slopes and couplings stay in the state, which must outlive the products that follow.
    virtual void assemble(const State& state, double inertia, MatrixUse use = MatrixUse::solves) = 0;
    /// y = A x with the assembled matrix, in its precision. @param x, y  three planes of state.size.vertex_stride
    virtual void multiply(const double* x, double* y) = 0;
    /// Solves A x = b.
    /// @param b  three planes of state.size.vertex_stride; pinned vertices must hold 0   @param x  like b; overwritten
    virtual LinearResult solve(const double* b, const LinearGoal& goal, double* x) = 0;
    virtual std::size_t bytes() const = 0;  ///< Memory held.
    /// Runs one operation on the vectors that the last solve left behind.
    virtual void run(LinearOperation operation) = 0;
};

/// Interpolations between particles from the coarse to the next finer level, finest first; may be empty.
using ParticleProlongations = std::vector<Prolongation>;

/// Turns interpolations between cloth vertices into ones between particles.
Prolongation particle_prolongation(const Prolongation& prolongation, const Topology& coarse, const Topology& fine);

/// Builds a solver whose matrices and vectors are float.
std::unique_ptr<LinearSolver> make_linear_solver_float(const State& state, const LinearOptions& options,
                                                       const ParticleProlongations& prolongations);
/// The same in double.
std::unique_ptr<LinearSolver> make_linear_solver_double(const State& state, const LinearOptions& options,
                                                        const ParticleProlongations& prolongations);

}  // namespace selvage
