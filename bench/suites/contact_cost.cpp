#include "bench/suites/contact_cost.hpp"

#include <algorithm>
#include <iostream>
#include <limits>
#include <stdexcept>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "bench/harness/child_run.hpp"
#include "bench/harness/machine.hpp"
#include "bench/harness/options.hpp"

namespace selvage {
namespace {

using Json = nlohmann::ordered_json;

struct ContactScene {
    std::string name;
    std::vector<std::string> arguments;
};

const std::vector<ContactScene>& contact_scenes()
{
    static const std::vector<ContactScene> all = {
        {"tshirt-coarse", {"builtin:tshirt", "--set", "garment.resolution=0.03"}},
        {"tshirt", {"builtin:tshirt"}},
        {"sphere", {"builtin:sphere", "--set", "sheet.resolution=65"}},
        {"fold", {"builtin:stress_fold", "--set", "sheet.resolution=17"}},
    };
    return all;
}

struct ContactOptions {
    std::string scene, program = own_program(), against;
    int repeats = 1;
};

// Times are the least of all repeats; all else is the same in each.
struct ContactCost {
    std::string scene, program;
    double contact_s = std::numeric_limits<double>::infinity(), search_s = contact_s;
    double newton_iterations = 0, whole = 0, partial = 0, measured = 0;
};

ContactOptions read_contact_options(const std::vector<std::string>& arguments)
{
    ContactOptions options;
    for (const auto& [name, value] :
         read_options("bench contact", arguments, {"--scene", "--repeats", "--program", "--against"},
                      "--scene NAME, --repeats N, --program FILE or --against FILE")) {
        if (name == "--scene") options.scene = value;
        if (name == "--repeats") options.repeats = read_number(name, value, 1, 100, "a number from 1 to 100");
        if (name == "--program") options.program = value;
        if (name == "--against") options.against = value;
    }
    return options;
}

// What a summary holds of a kernel; programs from before there was processor time have wall time only.
double of_kernel(const Json& summary, const std::string& kernel, const std::string& key)
{
    for (const Json& entry : summary["kernels"])
        if (entry["name"] == kernel)
            return entry.contains(key) ? entry[key].get<double>()
                                       : entry[key == "processor_seconds" ? "seconds" : key].get<double>();
    return 0;
}

void run_once(ContactCost& cost, const ContactScene& scene)
{
    std::vector<std::string> arguments = scene.arguments;
    for (const char* word : {"--threads", "1", "--set", "output.picture=false"}) arguments.push_back(word);
    const ChildRun run = run_child(cost.program, arguments);
    // What did not come to rest in time has its cost as well.
    if (run.summary.is_null()) throw std::runtime_error("bench contact: " + scene.name + ": " + run.errors);
    const Json summary = run.summary;
    const auto seconds = [&](const char* kernel) { return of_kernel(summary, kernel, "processor_seconds"); };
    cost.contact_s = std::min(cost.contact_s, seconds("cloth_contact_pairs") + seconds("cloth_contact_way") +
                                                  seconds("advance_held") + seconds("cloth_contact"));
    cost.search_s = std::min(cost.search_s, seconds("cloth_search") + seconds("cloth_search_part"));
    cost.newton_iterations = summary["newton_iterations"].get<double>();
    cost.whole = of_kernel(summary, "cloth_search", "calls");
    cost.partial = of_kernel(summary, "cloth_search_part", "calls");
    cost.measured = of_kernel(summary, "cloth_search", "items") + of_kernel(summary, "cloth_search_part", "items");
    std::cerr << fmt::format("{} {}: {:.3f} s\n", scene.name, cost.program, cost.contact_s);
}

std::vector<ContactCost> measure(const ContactOptions& options)
{
    std::vector<ContactCost> costs;
    std::vector<std::string> names;
    for (const ContactScene& scene : contact_scenes()) {
        names.push_back(scene.name);
        if (!options.scene.empty() && options.scene != scene.name) continue;
        std::vector<ContactCost> of_scene{{.scene = scene.name, .program = options.program}};
        if (!options.against.empty()) of_scene.push_back({.scene = scene.name, .program = options.against});
        for (int repeat = 0; repeat < options.repeats; ++repeat)
            for (ContactCost& cost : of_scene) run_once(cost, scene);
        costs.insert(costs.end(), of_scene.begin(), of_scene.end());
    }
    if (costs.empty())
        throw InputError({"", 0, 0, "--scene"}, "`" + options.scene + "`", "a scene of the suite",
                         nearest_name(options.scene, names));
    return costs;
}

// The other program's cost of the same scene stands behind that of the first; nothing if there is none, or for itself.
const ContactCost* other_of(const std::vector<ContactCost>& costs, std::size_t k)
{
    return k + 1 < costs.size() && costs[k + 1].scene == costs[k].scene ? &costs[k + 1] : nullptr;
}

std::string ratio(double value, double other) { return other > 0 ? fmt::format("{:.2f}", value / other) : "-"; }

std::string table(const std::vector<ContactCost>& costs)
{
    std::string text =
        fmt::format("{:<14} {:>10} {:>9} {:>7} {:>7} {:>8} {:>11} {:>13} {:>12}  {}\n", "scene", "contact s",
                    "search s", "Newton", "whole", "partial", "measured M", "time of other", "measured of", "program");
    for (std::size_t k = 0; k < costs.size(); ++k) {
        const ContactCost& c = costs[k];
        const ContactCost* other = other_of(costs, k);
        text += fmt::format("{:<14} {:>10.3f} {:>9.3f} {:>7} {:>7} {:>8} {:>11.2f} {:>13} {:>12}  {}\n", c.scene,
                            c.contact_s, c.search_s, c.newton_iterations, c.whole, c.partial, 1e-6 * c.measured,
                            other ? ratio(c.contact_s, other->contact_s) : "-",
                            other ? ratio(c.measured, other->measured) : "-", c.program);
    }
    return text +
           "times: processor time, the least of all repeats; contact: finding pairs, filtering steps and the energy of "
           "contact; whole, partial: searches for all corners and for those that left what had been searched; "
           "measured: pairs whose distance searches measured\n";
}

Json json_report(const std::vector<ContactCost>& costs)
{
    Json report;
    report["context"] = bench_context(1);
    report["benchmarks"] = Json::array();
    for (const ContactCost& c : costs) {
        Json run = timed_run(c.scene + "/" + c.program, c.contact_s, c.contact_s);
        run["search_time"] = c.search_s;
        run["newton_iterations"] = c.newton_iterations;
        run["whole_searches"] = c.whole;
        run["partial_searches"] = c.partial;
        run["measured"] = c.measured;
        report["benchmarks"].push_back(std::move(run));
    }
    return report;
}

}  // namespace

void bench_contact(bool json, const std::vector<std::string>& arguments, std::ostream& out)
{
    const std::vector<ContactCost> costs = measure(read_contact_options(arguments));
    out << (json ? json_report(costs).dump(2) + "\n" : table(costs));
}

}  // namespace selvage
