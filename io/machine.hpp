#pragma once
#include <cstdint>
#include <string>

namespace selvage {

/// What a measurement depends on.
struct MachineInfo {
    std::string cpu_name;
    int cores = 0;                  ///< That the process may use.
    std::int64_t memory_bytes = 0;  ///< That the process may use.
    std::string version;            ///< Of the program.
    std::string compiler, flags;    ///< The flags of C++ files, as given to the compiler.
    std::string build_type, instruction_set;
};

MachineInfo describe_machine();

}  // namespace selvage
