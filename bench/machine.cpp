#include "bench/machine.hpp"

#include <chrono>
#include <ctime>
#include <fstream>
#include <string>
#include <thread>

#include <nlohmann/json.hpp>

#include "io/version.hpp"

namespace selvage {
namespace {

std::string cpu_name()
{
    std::ifstream file("/proc/cpuinfo");
    for (std::string line; std::getline(file, line);)
        if (line.rfind("model name", 0) == 0 && line.find(": ") != std::string::npos) return line.substr(line.find(": ") + 2);
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

void describe_machine(nlohmann::ordered_json& context)
{
    context["version"] = version;
    context["compiler"] = compiler();
    context["build_type"] = build_type();
    context["instruction_set"] = instruction_set();
    context["cpu_name"] = cpu_name();
}

nlohmann::ordered_json bench_context(int threads)
{
    const std::time_t now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
    char date[32];
    std::strftime(date, sizeof date, "%Y-%m-%dT%H:%M:%S%z", std::localtime(&now));
    nlohmann::ordered_json context;
    context["date"] = date;
    context["num_cpus"] = int(std::thread::hardware_concurrency());
    describe_machine(context);
    context["threads"] = threads;
    return context;
}

}  // namespace selvage
