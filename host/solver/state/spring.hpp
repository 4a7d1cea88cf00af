#pragma once
#include <array>

namespace selvage {

/// What multiplies its constant; the numbers are those of kernels/terms/spring.h.
enum class SpringKind { membrane = 0, bend = 1, elastic = 2 };

/// One spring between two particles; see kernels/terms/spring.h.
struct Spring {
    std::array<int, 2> vertex{};
    double length = 0;                       ///< At rest [m].
    double constant = 0;                     ///< [N/m]
    double limit_length = 0;                 ///< Beyond it the spring is over-long [m].
    double limit_constant = 0;               ///< Constant there [N/m].
    SpringKind kind = SpringKind::membrane;  ///< A bend spring joins the opposite corners of a hinge.
};

}  // namespace selvage
