#include "validation/measure/direct_solver.hpp"

#include <stdexcept>

#include <Eigen/SparseCholesky>

#include "validation/measure/stiffness.hpp"

namespace selvage {
namespace {

class DirectSolver final : public LinearSolver {
public:
    explicit DirectSolver(bool plane) : plane_(plane) {}

    void assemble(const State& state, double inertia, MatrixUse) override
    {
        const int n = state.size.vertex_count;
        stride_ = state.size.vertex_stride;
        free_.clear();
        for (int v = 0; v < n; ++v)
            for (int c = 0; c < (plane_ ? 2 : 3) && state.inv_mass[v] > 0; ++c) free_.push_back(3 * v + c);
        matrix_ = submatrix(slot_stiffness(state, !state.hinge_slope.empty()), free_);
        for (int i = 0; i < int(free_.size()); ++i) matrix_.coeffRef(i, i) += inertia * state.mass[free_[i] / 3];
        factorise(matrix_);
    }

    LinearResult solve(const double* b, const LinearGoal&, double* x) override
    {
        scatter(factor_.solve(gathered(b)), x);
        return {1, 0, 0, false};
    }

    void multiply(const double* x, double* y) override { scatter(matrix_ * gathered(x), y); }

    std::size_t bytes() const override { return 0; }
    void run(LinearOperation) override {}

private:
    Eigen::VectorXd gathered(const double* planes) const
    {
        Eigen::VectorXd values(free_.size());
        for (int i = 0; i < int(free_.size()); ++i) values[i] = planes[free_[i] % 3 * stride_ + free_[i] / 3];
        return values;
    }
    void scatter(const Eigen::VectorXd& values, double* planes) const
    {
        std::fill(planes, planes + 3 * std::size_t(stride_), 0.0);
        for (int i = 0; i < int(free_.size()); ++i) planes[free_[i] % 3 * stride_ + free_[i] / 3] = values[i];
    }
    void factorise(const SparseMatrix& matrix)
    {
        if (matrix.nonZeros() != pattern_size_) factor_.analyzePattern(matrix);
        pattern_size_ = matrix.nonZeros();
        const double scale = matrix.diagonal().cwiseAbs().mean();
        for (double shift = 0; shift < 1e3; shift = shift == 0 ? 1e-8 : 10 * shift) {
            factor_.setShift(shift * scale);
            factor_.factorize(matrix);
            if (factor_.info() == Eigen::Success) return;
        }
        throw std::runtime_error("the stiffness matrix is not finite");
    }

    bool plane_;
    int stride_ = 0;
    Eigen::Index pattern_size_ = -1;
    std::vector<int> free_;
    SparseMatrix matrix_;
    Eigen::SimplicialLLT<SparseMatrix> factor_;
};

}  // namespace

std::unique_ptr<LinearSolver> make_direct_solver(bool plane) { return std::make_unique<DirectSolver>(plane); }

}  // namespace selvage
