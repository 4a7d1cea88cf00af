#include "bench/bench.hpp"

#include <iostream>

#include "bench/accuracy/motion_map.hpp"
#include "bench/accuracy/stability.hpp"
#include "bench/accuracy/work_precision.hpp"
#include "bench/suites/broad_phase.hpp"
#include "bench/suites/contact_cost.hpp"
#include "bench/suites/garments.hpp"
#include "bench/suites/kernels.hpp"
#include "bench/suites/scaling.hpp"
#include "bench/suites/skip.hpp"
#include "io/errors.hpp"

namespace selvage {
namespace {

struct Suite {
    std::string name;
    void (*run)(bool json, const std::vector<std::string>& options, std::ostream& out);
};

const std::vector<Suite>& suites()
{
    static const std::vector<Suite> all = {
        {"kernels", bench_kernels},     {"broad-phase", bench_broad_phase}, {"contact", bench_contact},
        {"skip", bench_skip},           {"scaling", bench_scaling},         {"work-precision", bench_work_precision},
        {"stability", bench_stability}, {"motion", bench_motion},           {"garments", bench_garments}};
    return all;
}

}  // namespace

std::vector<std::string> bench_suites()
{
    std::vector<std::string> names;
    for (const Suite& suite : suites()) names.push_back(suite.name);
    return names;
}

int run_bench(const std::string& suite, bool json, const std::vector<std::string>& options)
{
    for (const Suite& known : suites()) {
        if (known.name != suite) continue;
        known.run(json, options, std::cout);
        return 0;
    }
    const std::vector<std::string> names = bench_suites();
    throw InputError({"", 0, 0, "SUITE"}, "`" + suite + "`", "one of the suites that `selvage bench --help` lists",
                     nearest_name(suite, names));
}

}  // namespace selvage
