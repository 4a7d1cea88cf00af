#pragma once
#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "bench/suites/kernel_cloth.hpp"

namespace selvage {

/// One kernel or stage that can be measured alone.
struct KernelCase {
    std::string name;       ///< Such as `membrane/force` or `gather_forces`.
    std::string item;       ///< Kind of its items, such as `face`.
    int items = 0;          ///< Items per call.
    std::size_t bytes = 0;  ///< Bytes that a call must move; see host/solver/terms/traffic.hpp.
    std::function<void()> run = {};
    std::function<void()> prepare = {};  ///< Runs once before a series of calls; may be empty.
    std::function<void()> reset = {};    ///< Runs before every call and is not measured; may be empty.
};

/// Lists every function of every term and every stage of a step on this cloth, in the order in which a step runs them.
/// @param cloth  must outlive the cases
std::vector<KernelCase> kernel_cases(KernelCloth& cloth);

}  // namespace selvage
