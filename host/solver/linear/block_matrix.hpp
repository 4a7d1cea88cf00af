#pragma once
// Part of linear_device.cpp, which is built once per precision of `linear`: nothing here has external linkage.
#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Dense>

#include "host/parallel/launch.hpp"
#include "host/solver/linear/linear_solver.hpp"
#include "kernels/stages/assemble_row.h"
#include "kernels/stages/block_rows.h"
#include "kernels/stages/vector_rows.h"

namespace selvage {
namespace {

using LinearVector = std::vector<linear>;

/// Sparse matrix of 3x3 blocks; vectors hold xyz of one vertex together.
struct BlockMatrix {
    std::vector<int> row_begin, column;
    LinearVector block;

    int rows() const { return int(row_begin.size()) - 1; }
    std::size_t bytes() const
    {
        return block.size() * sizeof(linear) + (row_begin.size() + column.size()) * sizeof(int);
    }

    /// What y = A x must move [bytes].
    std::size_t product_bytes() const { return bytes() + 6 * std::size_t(rows()) * sizeof(linear); }

    /// y = A x in those rows that take part.
    void multiply(const Items& taking_part, const LinearVector& x, LinearVector& y) const
    {
        const double share = double(taking_part.count) / rows();
        const TraceScope scope("product", std::int64_t(share * double(product_bytes())),
                               std::int64_t(share * 2 * double(block.size())));
        launch<block_row_product>(taking_part,
                                  block_rows_args{row_begin.data(), column.data(), block.data(), x.data(), y.data()});
    }

    /// The position of block (row, row).
    int diagonal(int row) const
    {
        return int(std::lower_bound(column.begin() + row_begin[row], column.begin() + row_begin[row + 1], row) -
                   column.begin());
    }
};

double dot(const Items& rows, const LinearVector& a, const LinearVector& b)
{
    return launch_sum<row_dot>(rows, row_dot_args{a.data(), b.data()});
}

/// Inverse of the diagonal blocks.
class BlockJacobi {
public:
    void build(const Items& rows, const BlockMatrix& matrix)
    {
        inverse_.resize(9 * std::size_t(matrix.rows()));
        for_each_item(rows, [this, &matrix](int row) {
            using Block = Eigen::Matrix<linear, 3, 3, Eigen::RowMajor>;
            const Eigen::Map<const Block> source(matrix.block.data() + 9 * matrix.diagonal(row));
            Eigen::Matrix3d m = source.cast<double>();
            // A vertex that nothing holds yet would give a singular block.
            m.diagonal().array() += 1e-9 * m.trace() + 1e-300;
            Eigen::Map<Block>(inverse_.data() + 9 * std::size_t(row)) = m.inverse().cast<linear>();
        });
    }
    /// z = D^-1 r.
    void apply(const Items& rows, const LinearVector& r, LinearVector& z) const
    {
        launch<block_diagonal_product>(rows, block_diagonal_args{inverse_.data(), r.data(), z.data()});
    }
    std::size_t bytes() const { return inverse_.size() * sizeof(linear); }
    const linear* inverse() const { return inverse_.data(); }  ///< Nine entries per row.

private:
    LinearVector inverse_;
};

}  // namespace
}  // namespace selvage
