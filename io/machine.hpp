#pragma once
#include <cstdint>
#include <string>

namespace selvage {

/// The properties of the machine and the build that a measurement depends on.
struct MachineInfo {
    std::string cpu_name;
    int cores = 0;                  ///< Cores that the process may use.
    std::int64_t memory_bytes = 0;  ///< Memory that the process may use.
    std::string version;            ///< Version of the program.
    std::string compiler, flags;    ///< The flags are those of C++ files, as given to the compiler.
    std::string build_type, instruction_set;
};

/// Returns the properties of the present machine and build.
MachineInfo describe_machine();

}  // namespace selvage
