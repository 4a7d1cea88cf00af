#include "host/solver/stepping/step_failure.hpp"

#include <utility>

#include <fmt/format.h>

namespace selvage {

StepFailureError::StepFailureError(StepFailure known)
    : DivergenceError(fmt::format("no step down to {:.3g} s succeeds (solver.step is {:.3g} s); residual {:.3g}",
                                  known.step, known.longest, known.residual)),
      failure(std::move(known))
{
}

}  // namespace selvage
