#include "io/machine.hpp"

#include <fstream>
#include <thread>

#include "generated/build_flags.hpp"
#include "io/memory.hpp"
#include "io/version.hpp"

namespace selvage {
namespace {

std::string cpu_name()
{
    std::ifstream file("/proc/cpuinfo");
    for (std::string line; std::getline(file, line);)
        if (line.rfind("model name", 0) == 0 && line.find(": ") != std::string::npos)
            return line.substr(line.find(": ") + 2);
    return "unknown";
}

std::string compiler()
{
#ifdef __clang__
    return "clang " __clang_version__;
#else
    return "g++ " __VERSION__;
#endif
}

std::string build_type()
{
#if defined(__OPTIMIZE__) && defined(NDEBUG)
    return "optimised, without assertions";
#elif defined(__OPTIMIZE__)
    return "optimised, with assertions";
#else
    return "not optimised";
#endif
}

std::string instruction_set()
{
#if defined(__AVX512F__)
    return "avx512f";
#elif defined(__AVX2__) && defined(__FMA__)
    return "avx2 fma";
#elif defined(__AVX2__)
    return "avx2";
#else
    return "compiler's default";
#endif
}

}  // namespace

MachineInfo describe_machine()
{
    MachineInfo machine;
    machine.cpu_name = cpu_name();
    machine.cores = int(std::thread::hardware_concurrency());
    machine.memory_bytes = physical_memory_bytes();
    machine.version = version;
    machine.compiler = compiler();
    machine.flags = SELVAGE_FLAGS;
    machine.build_type = build_type();
    machine.instruction_set = instruction_set();
    return machine;
}

}  // namespace selvage
