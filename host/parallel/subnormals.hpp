#pragma once

namespace selvage {

/// Rounds subnormal floating-point numbers to zero (flush to zero, denormals are zero), in this thread and in the
/// threads that TBB starts from it afterwards. A program calls it first. Where parts of a cloth are at rest and others
/// are not, the linear solver's vectors hold residuals down to 1e-45, and processors calculate twenty times slower with
/// subnormal numbers. The function has an effect on x86 only.
void flush_subnormals();

}  // namespace selvage
