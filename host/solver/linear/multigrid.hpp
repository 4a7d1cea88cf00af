#pragma once
// Part of linear_device.cpp, which is built once per precision of `linear`: nothing here has external linkage.
#include <cstdint>
#include <string>

#include <Eigen/SparseCholesky>

#include "host/parallel/launch.hpp"
#include "host/solver/linear/block_matrix.hpp"

namespace selvage {
namespace {

/// Multigrid V-cycle on a hierarchy of interpolations with Galerkin coarse matrices P^T A P, Chebyshev smoothing over
/// block Jacobi, and a sparse Cholesky solve at the coarsest level, which is the finest where there is no other.
/// Symmetric, so it preconditions conjugate gradients.
/// Source: Tamstorf, Jones and McCormick 2015 for cloth; Adams and others 2003 for the smoother.
class Multigrid {
public:
    /// @param finest  pattern of the finest matrix
    /// @param pinned  per particle of the finest level: 1 if it is held, so that coarse levels leave it alone
    Multigrid(const BlockPattern& finest, const std::vector<char>& pinned, const ParticleProlongations& prolongations);

    /// Computes all coarse matrices and smoothers.
    /// @param rows      of the finest level that take part; the others are left alone as if they were pinned
    /// @param is_awake  per particle: 1 if it does; only read where not all do
    /// @param inv_mass  per particle: 0 if it is held, so that its row is one of the identity
    void build(const BlockMatrix& finest, const Items& rows, const std::vector<char>& is_awake,
               const std::vector<real>& inv_mass);
    /// Takes another finest matrix, which differs little, with the coarse ones as they are.
    void refresh(const BlockMatrix& finest)
    {
        if (!is_direct()) levels_[0].jacobi.build(levels_[0].rows, finest);
    }
    /// Whether the factor is that of the whole matrix.
    bool is_direct() const { return levels_.size() == 1; }
    /// z = one V-cycle applied to r.
    void apply(const BlockMatrix& finest, const LinearVector& r, LinearVector& z);
    std::size_t bytes() const;

private:
    struct Level {
        BlockMatrix matrix;  // empty at the finest level: the solver's own is used
        BlockJacobi jacobi;
        double largest_eigenvalue = 0;  // of D^-1 A, estimated from below and grown a little
        LinearVector x, next, b, d;     // next: what a pass makes of x, and residuals
        std::string name;               // in profiles
        Items rows;                     // those that take part
        std::vector<char> is_awake;     // per row, and their list; empty where all take part
        std::vector<int> awake;
        // Interpolation from the next coarser level, and its transpose.
        std::vector<int> prolong_begin, prolong_column, restrict_begin, restrict_row;
        std::vector<linear> prolong_weight, restrict_weight;
        // For each coarse row, the coarse block to which each product term of P^T A P adds, in order.
        std::vector<std::size_t> plan_begin;
        std::vector<int> plan;
    };

    void connect(Level& fine, const Prolongation& prolongation, const std::vector<char>* pinned, int coarse_rows);
    void plan_product(const std::vector<int>& row_begin, const std::vector<int>& column, Level& fine,
                      BlockMatrix& coarse);
    void select_rows(const Items& rows, const std::vector<char>& is_awake);
    static void coarse_matrix(const BlockMatrix& fine_matrix, const Level& fine, const Level& coarse_level,
                              BlockMatrix& coarse);
    void factorise_coarsest(const BlockMatrix& finest, const std::vector<real>& inv_mass);
    void estimate_eigenvalue(const BlockMatrix& matrix, Level& level);
    static block_smooth_args pass(const BlockMatrix& matrix, Level& level, const linear* b);
    void smooth(const BlockMatrix& matrix, Level& level, const linear* b, bool from_zero, linear* result = nullptr);
    void cycle(const BlockMatrix& matrix, std::size_t at, const linear* b, linear* result = nullptr);
    const BlockMatrix& matrix_of(const BlockMatrix& finest, std::size_t at) const
    {
        return at == 0 ? finest : levels_[at].matrix;
    }

    std::vector<Level> levels_;
    Eigen::SimplicialLLT<Eigen::SparseMatrix<double>> coarsest_;
};

Multigrid::Multigrid(const BlockPattern& finest, const std::vector<char>& pinned,
                     const ParticleProlongations& prolongations)
{
    levels_.resize(prolongations.size() + 1);
    for (std::size_t l = 0; l < levels_.size(); ++l) levels_[l].name = "level_" + std::to_string(l);
    for (std::size_t l = 0; l < prolongations.size(); ++l) {
        const int coarse_rows =
            prolongations[l].column.empty()
                ? 0
                : *std::max_element(prolongations[l].column.begin(), prolongations[l].column.end()) + 1;
        connect(levels_[l], prolongations[l], l == 0 ? &pinned : nullptr, coarse_rows);
        plan_product(l == 0 ? finest.row_begin : levels_[l].matrix.row_begin,
                     l == 0 ? finest.column : levels_[l].matrix.column, levels_[l], levels_[l + 1].matrix);
    }
    for (std::size_t l = 0; l < levels_.size(); ++l) {
        const std::size_t size = 3 * std::size_t(l == 0 ? finest.rows() : levels_[l].matrix.rows());
        for (LinearVector* v : {&levels_[l].x, &levels_[l].next, &levels_[l].d}) v->resize(size);
        if (l > 0) levels_[l].b.resize(size);  // the finest level reads the caller's
    }
}

void Multigrid::connect(Level& fine, const Prolongation& prolongation, const std::vector<char>* pinned, int coarse_rows)
{
    std::vector<std::vector<std::pair<int, linear>>> down(coarse_rows);
    fine.prolong_begin.assign(1, 0);
    for (int row = 0; row + 1 < int(prolongation.offset.size()); ++row) {
        for (int k = prolongation.offset[row]; k < prolongation.offset[row + 1]; ++k) {
            if ((pinned && (*pinned)[row]) || prolongation.weight[k] == 0) continue;
            fine.prolong_column.push_back(prolongation.column[k]);
            fine.prolong_weight.push_back(linear(prolongation.weight[k]));
            down[prolongation.column[k]].push_back({row, linear(prolongation.weight[k])});
        }
        fine.prolong_begin.push_back(int(fine.prolong_column.size()));
    }
    fine.restrict_begin.assign(1, 0);
    for (const auto& row : down) {
        for (const auto& [fine_row, weight] : row) {
            fine.restrict_row.push_back(fine_row);
            fine.restrict_weight.push_back(weight);
        }
        fine.restrict_begin.push_back(int(fine.restrict_row.size()));
    }
}

void Multigrid::plan_product(const std::vector<int>& row_begin, const std::vector<int>& column, Level& fine,
                             BlockMatrix& coarse)
{
    const int coarse_rows = int(fine.restrict_begin.size()) - 1;
    std::vector<int> mark(coarse_rows, -1), own;
    coarse.row_begin.assign(1, 0);
    fine.plan_begin.assign(1, 0);
    const auto visit = [&](int row, const auto& action) {
        for (int q = fine.restrict_begin[row]; q < fine.restrict_begin[row + 1]; ++q)
            for (int k = row_begin[fine.restrict_row[q]]; k < row_begin[fine.restrict_row[q] + 1]; ++k)
                for (int p = fine.prolong_begin[column[k]]; p < fine.prolong_begin[column[k] + 1]; ++p)
                    action(fine.prolong_column[p]);
    };
    for (int row = 0; row < coarse_rows; ++row) {
        own.assign(1, row);  // a coarse vertex that carries nothing still needs its diagonal
        mark[row] = 0;
        visit(row, [&](int c) {
            if (mark[c] < 0) {
                mark[c] = 0;
                own.push_back(c);
            }
        });
        std::sort(own.begin(), own.end());
        for (std::size_t k = 0; k < own.size(); ++k) mark[own[k]] = int(coarse.column.size() + k);
        coarse.column.insert(coarse.column.end(), own.begin(), own.end());
        coarse.row_begin.push_back(int(coarse.column.size()));
        visit(row, [&](int c) { fine.plan.push_back(mark[c]); });
        fine.plan_begin.push_back(fine.plan.size());
        for (int c : own) mark[c] = -1;
    }
    coarse.block.resize(9 * coarse.column.size());
}

// A coarse row takes part if one does that it interpolates to. Vectors hold zero in the others.
void Multigrid::select_rows(const Items& rows, const std::vector<char>& is_awake)
{
    for (std::size_t l = 0; l < levels_.size(); ++l) {
        Level& level = levels_[l];
        level.awake.clear();
        level.is_awake.clear();
        const int count = int(level.x.size() / 3);
        level.rows = l == 0 ? rows : Items{count};
        if (!rows.list) continue;
        for (LinearVector* v : {&level.x, &level.next, &level.d, &level.b}) std::fill(v->begin(), v->end(), linear(0));
        if (l == 0) {
            level.is_awake = is_awake;
            continue;
        }
        const Level& fine = levels_[l - 1];
        level.is_awake.resize(std::size_t(count));
        for (int row = 0; row < count; ++row) {
            for (int k = fine.restrict_begin[row]; k < fine.restrict_begin[row + 1] && !level.is_awake[row]; ++k)
                level.is_awake[row] = fine.is_awake[fine.restrict_row[k]];
            if (level.is_awake[row]) level.awake.push_back(row);
        }
        level.rows = {int(level.awake.size()), level.awake.data()};
    }
}

void Multigrid::coarse_matrix(const BlockMatrix& a, const Level& fine, const Level& coarse_level, BlockMatrix& coarse)
{
    const TraceScope scope("coarse_matrix");
    for_each_item(coarse.rows(), [&](int row) {
        linear* const first = coarse.block.data() + 9 * std::size_t(coarse.row_begin[row]);
        std::fill(first, coarse.block.data() + 9 * std::size_t(coarse.row_begin[row + 1]), linear(0));
        linear* const diagonal = coarse.block.data() + 9 * std::size_t(coarse.diagonal(row));
        if (!coarse_level.is_awake.empty() && !coarse_level.is_awake[row]) {
            for (int c = 0; c < 9; c += 4) diagonal[c] = 1;
            return;
        }
        std::size_t term = fine.plan_begin[row];
        for (int q = fine.restrict_begin[row]; q < fine.restrict_begin[row + 1]; ++q) {
            const int i = fine.restrict_row[q];
            for (int k = a.row_begin[i]; k < a.row_begin[i + 1]; ++k) {
                const linear* from = a.block.data() + 9 * std::size_t(k);
                const int j = a.column[k];
                if (!fine.is_awake.empty() && !(fine.is_awake[i] && fine.is_awake[j])) {
                    term += std::size_t(fine.prolong_begin[j + 1] - fine.prolong_begin[j]);
                    continue;
                }
                for (int p = fine.prolong_begin[j]; p < fine.prolong_begin[j + 1]; ++p) {
                    linear* to = coarse.block.data() + 9 * std::size_t(fine.plan[term++]);
                    const linear weight = fine.restrict_weight[q] * fine.prolong_weight[p];
                    for (int c = 0; c < 9; ++c) to[c] += weight * from[c];
                }
            }
        }
        for (int c = 0; c < 9; c += 4)
            if (!(diagonal[c] > 0)) diagonal[c] = 1;
    });
}

void Multigrid::factorise_coarsest(const BlockMatrix& finest, const std::vector<real>& inv_mass)
{
    const TraceScope scope("factorise_coarsest");
    const BlockMatrix& a = matrix_of(finest, levels_.size() - 1);
    const std::vector<char>& is_awake = levels_.back().is_awake;
    const auto stands_alone = [&](int row) {
        return is_direct() && (inv_mass[row] == 0 || (!is_awake.empty() && !is_awake[row]));
    };
    std::vector<Eigen::Triplet<double>> entries;
    entries.reserve(9 * a.column.size());
    for (int row = 0; row < a.rows(); ++row)
        for (int k = a.row_begin[row]; k < a.row_begin[row + 1]; ++k) {
            const int column = a.column[k];
            const bool apart = stands_alone(row) || stands_alone(column);
            for (int c = 0; c < 9; ++c) {
                const double own = row == column && c % 4 == 0;
                entries.emplace_back(3 * row + c / 3, 3 * column + c % 3,
                                     apart ? own : double(a.block[9 * std::size_t(k) + c]));
            }
        }
    Eigen::SparseMatrix<double> matrix(3 * a.rows(), 3 * a.rows());
    matrix.setFromTriplets(entries.begin(), entries.end());
    if (coarsest_.rows() == 0) coarsest_.analyzePattern(matrix);
    // An indefinite matrix (full Hessian of compressed cloth) is shifted until it can be factorised.
    double shift = 1e-9 * std::max(matrix.diagonal().sum(), 1e-300) / double(matrix.rows());
    for (int attempt = 0; attempt < 16; ++attempt, shift *= 10) {
        coarsest_.setShift(shift);
        coarsest_.factorize(matrix);
        if (coarsest_.info() == Eigen::Success) return;
    }
}

// Power iteration from the same start each time: what a solve does must not depend on the solves before it, or a
// resumed run would go another way.
void Multigrid::estimate_eigenvalue(const BlockMatrix& matrix, Level& level)
{
    const TraceScope scope("eigenvalue");
    std::uint32_t seed = 1;
    for (linear& v : level.x) v = linear(int((seed = seed * 1664525u + 1013904223u) >> 16) % 2001 - 1000) / 1000;
    for (std::size_t row = 0; row < level.is_awake.size(); ++row)
        if (!level.is_awake[row]) std::fill_n(level.x.begin() + std::ptrdiff_t(3 * row), 3, linear(0));
    double growth = 1;
    for (int round = 0; round < 7; ++round) {
        const double size = std::sqrt(dot(level.rows, level.x, level.x));
        launch<row_scale>(level.rows, row_scale_args{level.x.data(), linear(1 / size)});
        matrix.multiply(level.rows, level.x, level.next);
        level.jacobi.apply(level.rows, level.next, level.x);
        growth = std::sqrt(dot(level.rows, level.x, level.x));
    }
    level.largest_eigenvalue = 1.15 * growth;
}

void Multigrid::build(const BlockMatrix& finest, const Items& rows, const std::vector<char>& is_awake,
                      const std::vector<real>& inv_mass)
{
    const TraceScope scope("multigrid_build");
    select_rows(rows, is_awake);
    for (std::size_t l = 0; l < levels_.size(); ++l) {
        if (l + 1 == levels_.size()) {
            factorise_coarsest(finest, inv_mass);
            return;
        }
        const BlockMatrix& matrix = matrix_of(finest, l);
        coarse_matrix(matrix, levels_[l], levels_[l + 1], levels_[l + 1].matrix);
        levels_[l].jacobi.build(levels_[l].rows, matrix);
        estimate_eigenvalue(matrix, levels_[l]);
    }
}

block_smooth_args Multigrid::pass(const BlockMatrix& matrix, Level& level, const linear* b)
{
    return {matrix.row_begin.data(),
            matrix.column.data(),
            matrix.block.data(),
            level.jacobi.inverse(),
            b,
            level.x.data(),
            level.d.data(),
            level.next.data(),
            0,
            0};
}

// Two Chebyshev steps on the upper part of the spectrum of D^-1 A; the result goes to the level's x unless told.
void Multigrid::smooth(const BlockMatrix& matrix, Level& level, const linear* b, bool from_zero, linear* result)
{
    const double high = level.largest_eigenvalue, low = high / 6, middle = 0.5 * (high + low),
                 radius = 0.5 * (high - low);
    const double sigma = middle / radius, rho = 1 / (2 * sigma - 1 / sigma);
    const double share = double(level.rows.count) / matrix.rows();
    const TraceScope scope("smooth", std::int64_t(share * (from_zero ? 1 : 2) * double(matrix.product_bytes())),
                           std::int64_t(share * (from_zero ? 2 : 4) * double(matrix.block.size())));
    block_smooth_args first = pass(matrix, level, b);
    first.gain = linear(1 / middle);
    if (from_zero)
        launch<block_row_smooth_zero>(level.rows, first);
    else
        launch<block_row_smooth>(level.rows, first);
    level.x.swap(level.next);
    block_smooth_args second = pass(matrix, level, b);
    second.keep = linear(rho / sigma);
    second.gain = linear(2 * rho / radius);
    if (result) second.next = result;
    launch<block_row_smooth>(level.rows, second);
    if (!result) level.x.swap(level.next);
}

// Leaves the correction in the level's x, or where it is told to.
void Multigrid::cycle(const BlockMatrix& matrix, std::size_t at, const linear* b, linear* result)
{
    Level& level = levels_[at];
    const TraceScope scope(level.name);
    if (at + 1 == levels_.size()) {
        const Eigen::Map<const Eigen::Matrix<linear, Eigen::Dynamic, 1>> right(b, Eigen::Index(level.x.size()));
        const Eigen::VectorXd x = coarsest_.solve(right.template cast<double>());
        for (Eigen::Index i = 0; i < x.size(); ++i) (result ? result : level.x.data())[i] = linear(x[i]);
        return;
    }
    Level& coarse = levels_[at + 1];
    smooth(matrix, level, b, true);
    launch<block_row_residual>(level.rows, pass(matrix, level, b));
    launch<row_restrict>(coarse.rows,
                         row_transfer_args{level.restrict_begin.data(), level.restrict_row.data(),
                                           level.restrict_weight.data(), level.next.data(), coarse.b.data()});
    cycle(coarse.matrix, at + 1, coarse.b.data());
    launch<row_prolong>(level.rows, row_transfer_args{level.prolong_begin.data(), level.prolong_column.data(),
                                                      level.prolong_weight.data(), coarse.x.data(), level.x.data()});
    smooth(matrix, level, b, false, result);
}

void Multigrid::apply(const BlockMatrix& finest, const LinearVector& r, LinearVector& z)
{
    const TraceScope scope("multigrid_cycle");
    cycle(finest, 0, r.data(), z.data());
}

std::size_t Multigrid::bytes() const
{
    std::size_t total = 0;
    for (const Level& level : levels_)
        total += level.matrix.bytes() + level.jacobi.bytes() + 4 * level.x.size() * sizeof(linear) +
                 (level.prolong_column.size() + level.restrict_row.size()) * (sizeof(int) + sizeof(linear)) +
                 level.plan.size() * sizeof(int) + level.plan_begin.size() * sizeof(std::size_t);
    return total;
}

}  // namespace
}  // namespace selvage
