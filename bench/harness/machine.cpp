#include "bench/harness/machine.hpp"

#include <chrono>
#include <ctime>

#include <nlohmann/json.hpp>

#include "io/machine.hpp"

namespace selvage {

void describe_machine(nlohmann::ordered_json& context)
{
    const MachineInfo machine = describe_machine();
    context["version"] = machine.version;
    context["compiler"] = machine.compiler;
    context["flags"] = machine.flags;
    context["build_type"] = machine.build_type;
    context["instruction_set"] = machine.instruction_set;
    context["cpu_name"] = machine.cpu_name;
    context["memory_bytes"] = machine.memory_bytes;
}

nlohmann::ordered_json bench_context(int threads)
{
    const std::time_t now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
    char date[32];
    std::strftime(date, sizeof date, "%Y-%m-%dT%H:%M:%S%z", std::localtime(&now));
    nlohmann::ordered_json context;
    context["date"] = date;
    context["num_cpus"] = describe_machine().cores;
    describe_machine(context);
    context["threads"] = threads;
    return context;
}

nlohmann::ordered_json timed_run(const std::string& name, double wall, double processor)
{
    return {{"name", name},      {"run_name", name},      {"run_type", "iteration"}, {"iterations", 1},
            {"real_time", wall}, {"cpu_time", processor}, {"time_unit", "s"}};
}

}  // namespace selvage
