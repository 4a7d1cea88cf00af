// The linear solver of the implicit steps. Built twice, with SELVAGE_LINEAR = float and double.
#include "host/parallel/launch.hpp"
#include "host/solver/linear/linear_solver.hpp"

#include <algorithm>
#include <optional>
#include <vector>

#include "host/solver/linear/block_matrix.hpp"
#include "host/solver/linear/multigrid.hpp"
#include "host/solver/state/pair_list.hpp"
#include "host/solver/terms/terms.hpp"
#include "kernels/stages/couple_hinges.h"
#include "kernels/stages/vector_ops.h"

namespace selvage {
namespace {

// The last iterations, whose gains stand for the error that is left (Hestenes and Stiefel 1952; Strakos and Tichy
// 2002). Block Jacobi has long stretches in which little seems to be gained: over 8 iterations it was taken in by them,
// at stretch stiffness of 1e7 N/m in steps of 33 ms. A factor of the matrix lacks the couplings of plates: over 2
// iterations a pendulum of 81 vertices missed 0.05 of gravity.
constexpr int window_of_multigrid = 2, window_of_factor = 6, window_of_jacobi = 20;

// Times the iterations of the first solve with new coarse matrices: as many may be taken before they are made anew.
constexpr double worth_of_coarse = 1.3;

// Relative residual below which rounding is all that is left.
constexpr double rounding_residual = sizeof(linear) == sizeof(float) ? 1e-6 : 1e-13;

// The error in the energy norm, estimated from what the iterations gain.
class EnergyError {
public:
    // @param scale  |b|, by which the right side was divided   @param window  see above
    EnergyError(const LinearGoal& goal, double scale, std::size_t window)
        : goal_(goal), square_of_scale_(scale * scale), window_(window)
    {
    }

    // @param gain  twice what the iteration took off the quadratic model, of the scaled system
    void add(double gain)
    {
        gains_.push_back(gain * square_of_scale_);
        total_ += gains_.back();
    }

    double left() const
    {
        double last = 0;
        for (std::size_t k = gains_.size() - std::min(window_, gains_.size()); k < gains_.size(); ++k)
            last += gains_[k];
        return last;
    }

    bool is_met() const
    {
        const double part = goal_.energy_part * goal_.energy_part;
        return gains_.size() >= window_ && left() <= std::max(part * total_, goal_.energy_left);
    }

private:
    const LinearGoal& goal_;
    double square_of_scale_;
    std::size_t window_;
    double total_ = 0;
    std::vector<double> gains_;
};

class ConjugateGradients final : public LinearSolver {
public:
    ConjugateGradients(const State& state, const LinearOptions& options, const ParticleProlongations& prolongations)
        : options_(options), pattern_(make_pattern(state)), stride_(state.size.vertex_stride)
    {
        matrix_.row_begin = pattern_.row_begin;
        matrix_.column = pattern_.column;
        matrix_.block.resize(9 * pattern_.column.size());
        if (!state.hinge_slope.empty()) {
            turn_.resize(std::size_t(state.size.hinge_count));
            moment_.resize(turn_.size());
        }
        for (LinearVector* v : {&x_, &r_, &z_, &p_, &q_}) v->resize(3 * std::size_t(pattern_.rows()));
        const bool direct = options.preconditioner == Preconditioner::direct;
        if (!direct && (options.preconditioner != Preconditioner::multigrid || prolongations.empty())) return;
        std::vector<char> pinned(pattern_.rows());
        for (int v = 0; v < pattern_.rows(); ++v) pinned[v] = state.inv_mass[v] == 0;
        multigrid_.emplace(pattern_, pinned, direct ? ParticleProlongations{} : prolongations);
    }

    void assemble(const State& state, double inertia, MatrixUse use) override
    {
        const assemble_args args{
            pattern_.row_begin.data(), pattern_.column.data(),
            matrix_.block.data(),      state.mass.data(),
            state.inv_mass.data(),     state.vertex_stiffness.empty() ? nullptr : state.vertex_stiffness.data(),
            state.size.vertex_stride,  inertia};
        const assemble_kind kinds[] = {
#define KIND(kind, corner_count)                                               \
    {state.kind##_slots.data(),                                                \
     state.kind##_slot.data(),                                                 \
     pattern_.kind##_place.data(),                                             \
     state.kind##_stiffness.empty() ? nullptr : state.kind##_stiffness.data(), \
     corner_count,                                                             \
     state.size.kind##_stride},
            ELEMENT_KINDS(KIND)
#undef KIND
        };
        rows_ = items_of(state, ItemKind::vertex);
        // What sleeps is as good as pinned: its rows are not looked at, and vectors hold zero there.
        if (rows_.list)
            for (LinearVector* v : {&x_, &r_, &z_, &p_, &q_, &turn_, &moment_})
                std::fill(v->begin(), v->end(), linear(0));
        for_each_item(rows_, [&args, &kinds](int row) {
            assemble_clear(row, &args);
            for (const assemble_kind& kind : kinds)
                if (kind.stiffness) assemble_elements(row, &args, &kind);
            assemble_finish(row, &args);
        });
        state_ = &state;
        if (use == MatrixUse::products) return;
        if (!multigrid_)
            jacobi_.build(rows_, matrix_);
        else if (use == MatrixUse::likewise && coarse_serves())
            multigrid_->refresh(matrix_);
        else {
            multigrid_->build(matrix_, rows_, state.awake.is_awake, state.inv_mass);
            first_iterations_ = last_iterations_ = -1;
        }
    }

    void multiply(const double* x, double* y) override
    {
        launch<row_pack>(pattern_.rows(), row_pack_args{p_.data(), x, stride_, 1});
        multiply(p_, q_);
        launch<row_unpack>(pattern_.rows(), row_unpack_args{y, q_.data(), stride_, 1});
    }

    LinearResult solve(const double* b, const LinearGoal& goal, double* x) override
    {
        LinearResult result;
        const double scale = std::sqrt(launch_sum<vertex_dot>(rows_, vertex_pair_args{b, b, stride_}));
        launch<row_pack>(rows_, row_pack_args{r_.data(), b, stride_, scale > 0 ? scale : 1});
        launch<row_clear>(rows_, row_scale_args{x_.data(), 0});
        result.relative_residual = scale > 0 ? 1 : 0;
        if (scale > 0) iterate(goal, scale, result);
        last_iterations_ = result.iterations;
        if (first_iterations_ < 0) first_iterations_ = result.iterations;
        launch<row_unpack>(pattern_.rows(), row_unpack_args{x, x_.data(), stride_, scale});
        return result;
    }

    std::size_t bytes() const override
    {
        return matrix_.bytes() + jacobi_.bytes() + (5 * x_.size() + 2 * turn_.size()) * sizeof(linear) +
               (multigrid_ ? multigrid_->bytes() : 0) + pattern_.place_bytes() +
               (pattern_.column.size() + pattern_.row_begin.size()) * sizeof(int);
    }

    void run(LinearOperation operation) override
    {
        switch (operation) {
            case LinearOperation::product:
                multiply(p_, q_);
                break;
            case LinearOperation::precondition:
                precondition();
                break;
            case LinearOperation::dot:
                dot(rows_, r_, z_);
                break;
            case LinearOperation::update:
                advance(linear(1e-12));
                break;
        }
    }

private:
    // y = A x: the assembled matrix, and what of the stiffness of plates and contacts does not stand in it.
    void multiply(const LinearVector& x, LinearVector& y)
    {
        matrix_.multiply(rows_, x, y);
        if (!turn_.empty()) couple_hinges(x, y);
        if (state_->size.pair_count > 0) couple_pairs(x, y);
    }

    void couple_hinges(const LinearVector& x, LinearVector& y)
    {
        const State& s = *state_;
        const couple_args args{s.hinge_vertex.data(),
                               s.hinge_slope.data(),
                               s.plate_diagonal.data(),
                               s.coupling_slots.data(),
                               s.coupling_hinge.data(),
                               s.coupling_rigidity.data(),
                               s.hinge_slots.data(),
                               s.hinge_slot.data(),
                               x.data(),
                               turn_.data(),
                               moment_.data(),
                               y.data(),
                               s.size.hinge_stride,
                               s.size.vertex_stride};
        const Items hinges = items_of(s, ItemKind::hinge);
        launch<couple_turn>(hinges, args);
        launch<couple_moment>(hinges, args);
        launch<couple_gather>(rows_, args);
    }

    void couple_pairs(const LinearVector& x, LinearVector& y)
    {
        const State& s = *state_;
        relative_.resize(6 * std::size_t(s.size.pair_count));
        const couple_pairs_args args{pair_list_of(s), x.data(), relative_.data(), y.data(), s.inv_mass.data()};
        launch<couple_pairs_relative>(s.size.pair_count, args);
        launch<couple_pairs_gather>(rows_, args);
    }

    // The coarse matrices of a matrix before are as good as new while solves take hardly longer.
    bool coarse_serves() const
    {
        return first_iterations_ >= 0 && last_iterations_ <= worth_of_coarse * first_iterations_ + 1;
    }

    void precondition()
    {
        if (multigrid_)
            multigrid_->apply(matrix_, r_, z_);
        else
            jacobi_.apply(rows_, r_, z_);
    }

    // x += step p, r -= step q.
    void advance(linear step)
    {
        launch<row_advance>(rows_, row_advance_args{x_.data(), r_.data(), p_.data(), q_.data(), step});
    }

    void iterate(const LinearGoal& goal, double scale, LinearResult& result)
    {
        const int at_most = std::min(goal.at_most, options_.max_iterations);
        const int window = !multigrid_               ? window_of_jacobi
                           : multigrid_->is_direct() ? window_of_factor
                                                     : window_of_multigrid;
        EnergyError error(goal, scale, std::size_t(window));
        precondition();
        p_ = z_;
        double rz = dot(rows_, r_, z_);
        while (result.iterations < at_most) {
            multiply(p_, q_);
            const double curvature = dot(rows_, p_, q_);
            if (!(curvature > 0) || !(rz > 0)) {
                result.negative_curvature = true;
                if (result.iterations == 0) x_ = p_;  // a descent direction is better than none
                return;
            }
            advance(linear(rz / curvature));
            ++result.iterations;
            result.relative_residual = std::sqrt(dot(rows_, r_, r_));
            error.add(rz * rz / curvature);
            result.energy_left = error.left();
            const double enough = goal.energy_part > 0 ? rounding_residual : goal.residual;
            if (result.relative_residual <= enough || (goal.energy_part > 0 && error.is_met())) return;
            precondition();
            const double next = dot(rows_, r_, z_);
            launch<row_turn>(rows_, row_turn_args{p_.data(), z_.data(), linear(next / rz)});
            rz = next;
        }
    }

    LinearOptions options_;
    BlockPattern pattern_;
    int stride_;
    BlockMatrix matrix_;
    BlockJacobi jacobi_;
    std::optional<Multigrid> multigrid_;
    const State* state_ = nullptr;  // of the last assembly
    Items rows_;                    // those awake then
    LinearVector x_, r_, z_, p_, q_;
    LinearVector turn_, moment_;                        // per hinge; empty without a plate
    LinearVector relative_;                             // per pair in contact
    int first_iterations_ = -1, last_iterations_ = -1;  // of solves since the coarse matrices were made; -1: none
};

}  // namespace

#define JOIN_EXPANDED(a, b) a##b
#define JOIN(a, b) JOIN_EXPANDED(a, b)
std::unique_ptr<LinearSolver> JOIN(make_linear_solver_, SELVAGE_LINEAR)(const State& state,
                                                                        const LinearOptions& options,
                                                                        const ParticleProlongations& prolongations)
{
    return std::make_unique<ConjugateGradients>(state, options, prolongations);
}

}  // namespace selvage
