#include <cmath>
#include <iostream>
#include <map>
#include <sstream>

#include <nlohmann/json.hpp>

#include "bench/bench.hpp"
#include "bench/suites/kernel_cloth.hpp"
#include "bench/suites/scaling.hpp"
#include "bench/suites/skip_cases.hpp"
#include "host/solver/terms/traffic.hpp"
#include "io/errors.hpp"
#include "io/scene/read_scene.hpp"
#include "io/scene/scene.hpp"
#include "io/version.hpp"
#include "validation/unit/catch.hpp"
#include "validation/unit/scratch_file.hpp"

using namespace selvage;

namespace {

// Returns the output of the suite for a small cloth.
std::string printed(bool json, std::vector<std::string> options)
{
    options.insert(options.begin(), {"--vertices", "625", "--threads", "2", "--min-time", "0.001"});
    std::ostringstream text;
    std::streambuf* const before = std::cout.rdbuf(text.rdbuf());
    const int code = run_bench("kernels", json, options);
    std::cout.rdbuf(before);
    CHECK(code == 0);
    return text.str();
}

std::vector<std::string> expected_names()
{
    std::vector<std::string> names = {"body_query",
                                      "clear_forces",
                                      "gather_forces",
                                      "clear_stiffness",
                                      "assemble",
                                      "matrix_product",
                                      "precondition/block_jacobi",
                                      "precondition/multigrid",
                                      "dot",
                                      "axpy",
                                      "settle_friction",
                                      "settle_hysteresis",
                                      "newton_iteration"};
    for (const Term& term : all_terms())
        for (const char* part : {"/value", "/force", "/stiffness"}) names.push_back(std::string(term.name) + part);
    return names;
}

// Loads that do not depend on where the cloth is have none.
bool has_stiffness(const std::string& name) { return name != "gravity/stiffness" && name != "wind/stiffness"; }

const Term& term_named(std::string_view name)
{
    for (const Term& term : all_terms())
        if (term.name == name) return term;
    throw std::invalid_argument("no such term");
}

}  // namespace

TEST_CASE("the kernel benchmark measures every function of every term and every stage once", "[bench]")
{
    const nlohmann::json result = nlohmann::json::parse(printed(true, {}));
    std::map<std::string, nlohmann::json> runs;
    for (const nlohmann::json& run : result["benchmarks"]) {
        INFO(run["name"]);
        CHECK(runs.emplace(run["name"], run).second);
    }
    CHECK(runs.size() == expected_names().size());
    for (const std::string& name : expected_names()) {
        INFO(name);
        REQUIRE(runs.count(name) == 1);
        const nlohmann::json& run = runs[name];
        for (const char* key : {"real_time", "ns_per_item", "items", "items_per_second"}) {
            CHECK(std::isfinite(run[key].get<double>()));
            CHECK(run[key].get<double>() > 0);
        }
        for (const char* key : {"bytes_per_item", "bytes_per_second", "copy_fraction"}) {
            CHECK(std::isfinite(run[key].get<double>()));
            CHECK((run[key].get<double>() > 0) == has_stiffness(name));
        }
        const double bandwidth = result["context"]["copy_bytes_per_second"];
        CHECK(run["copy_fraction"].get<double>() ==
              Approx(run["bytes_per_second"].get<double>() / bandwidth).epsilon(1e-6));
        CHECK(run["bytes_per_second"].get<double>() ==
              Approx(run["bytes_per_item"].get<double>() / run["ns_per_item"].get<double>() * 1e9).epsilon(1e-6));
        CHECK(run["time_unit"] == "ns");
    }
}

TEST_CASE("the kernel benchmark's context names the machine, the build and the copy bandwidth", "[bench]")
{
    const nlohmann::json context = nlohmann::json::parse(printed(true, {"--filter", "^dot$"}))["context"];
    CHECK(context["version"] == version);
    CHECK(context["threads"] == 2);
    CHECK(context["vertices"] == 625);
    CHECK(context["num_cpus"].get<int>() > 0);
    CHECK(context["copy_bytes_per_second"].get<double>() > 1e8);
    for (const char* key : {"cpu_name", "compiler", "build_type", "instruction_set"})
        CHECK_FALSE(context[key].get<std::string>().empty());
}

TEST_CASE("the kernel benchmark's table has one row for each kernel that the filter matches", "[bench]")
{
    const std::string text = printed(false, {"--filter=^(dot|membrane/force)$"});
    std::istringstream lines(text.substr(text.find("kernel ")));
    std::vector<std::string> rows;
    for (std::string line; std::getline(lines, line) && !line.empty();) rows.push_back(line);
    REQUIRE(rows.size() == 3);
    CHECK(rows[1].rfind("membrane/force", 0) == 0);
    CHECK(rows[2].rfind("dot", 0) == 0);
    CHECK(rows[1].size() == rows[0].size());
    CHECK(rows[2].size() == rows[0].size());
}

TEST_CASE("bad options of the kernel benchmark are input errors", "[bench]")
{
    for (const std::vector<std::string>& options :
         std::vector<std::vector<std::string>>{{"--vertices", "many"},
                                               {"--vertices", "3"},
                                               {"--vertices"},
                                               {"--threads", "-1"},
                                               {"--min-time", "0"},
                                               {"--min-time", "nan"},
                                               {"--filter", "("},
                                               {"--vertexes", "100"},
                                               {"100"},
                                               {"--vertices", "100", "--filter", "no_such_kernel"}}) {
        INFO(options.front() << ' ' << options.back());
        CHECK_THROWS_AS(run_bench("kernels", true, options), InputError);
    }
    CHECK_THROWS_AS(run_bench("kernel", true, {}), InputError);
}

TEST_CASE("the bytes of a kernel follow from its field list", "[bench]")
{
    const KernelCloth cloth(400);
    const mesh_sizes& size = cloth.state.size;
    const std::size_t vertices = size.vertex_count, faces = size.face_count, stitches = size.stitch_count;
    // The positions of all vertices, then corners, material, area and weights per face; the force is read and written.
    CHECK(term_bytes(term_named("membrane"), cloth.state, TermPart::value) ==
          vertices * 24 + faces * (12 + 4 + 8 + 32) + 32);
    CHECK(term_bytes(term_named("membrane"), cloth.state, TermPart::force) ==
          vertices * 24 + faces * (12 + 4 + 8 + 32 + 2 * 72) + 32);
    CHECK(term_bytes(term_named("gravity"), cloth.state, TermPart::stiffness) == 0);
    // The stitches of this cloth have no vertex in common, and most vertices belong to none.
    CHECK(2 * stitches < vertices);
    CHECK(term_bytes(term_named("seam"), cloth.state, TermPart::value) <= stitches * (8 + 2 * 24));
    CHECK(term_bytes(term_named("seam"), cloth.state, TermPart::value) > stitches * (8 + 24));
    CHECK(clear_forces_bytes(cloth.state) == 24 * vertices + 72 * faces +
                                                 96 * std::size_t(size.hinge_count + size.pair_count) +
                                                 48 * (stitches + size.spring_count));
}

TEST_CASE("the cloth of the kernel benchmark gives every term and stage work to do", "[bench]")
{
    KernelCloth cloth(400);
    for (const Term& term : all_terms()) {
        INFO(term.name);
        CHECK(term.is_active(cloth.params));
        CHECK(term.item_count(cloth.state.size) > 0);
        CHECK(std::abs(term.energy(cloth.state, cloth.params)) > 0);
    }
    CHECK(cloth.contact->contact_count() == cloth.state.size.vertex_count);
    CHECK_FALSE(cloth.prolongations.empty());
    const std::vector<real> before = cloth.state.pos;
    cloth.state.pos[0] += 0.1;
    cloth.reset();
    CHECK(cloth.state.pos == before);
}

TEST_CASE("growth exponents are the slopes of power laws, by least squares", "[bench]")
{
    CHECK(*growth_exponent({10, 100, 1000}, {3, 300, 30000}) == Approx(2));
    CHECK(*growth_exponent({1, 4, 16}, {2, 2, 2}) == Approx(0).margin(1e-12));
    // Of three points, a factor of 1.1 at an end changes the slope by half of the factor's logarithm.
    CHECK(*growth_exponent({1, 10, 100}, {1, 10, 110}) == Approx(1 + 0.5 * std::log10(1.1)));
    CHECK_FALSE(growth_exponent({5}, {1}));
    CHECK_FALSE(growth_exponent({5, 5}, {1, 2}));
}

TEST_CASE("bad options of the scaling and skip benchmarks are input errors", "[bench]")
{
    for (const std::vector<std::string>& options :
         std::vector<std::vector<std::string>>{{"--scene", "hangin"},
                                               {"--max-vertices", "10"},
                                               {"--min-vertices", "5000", "--max-vertices", "1000"},
                                               {"--threads", "0"},
                                               {"--max-seconds", "0"},
                                               {"--vertices", "100"}}) {
        INFO(options.front() << ' ' << options.back());
        CHECK_THROWS_AS(run_bench("scaling", true, options), InputError);
    }
    for (const std::vector<std::string>& options : std::vector<std::vector<std::string>>{
             {"--resolution", "2"}, {"--repeats", "0"}, {"--until", "-1"}, {"--repeat", "3"}}) {
        INFO(options.front() << ' ' << options.back());
        CHECK_THROWS_AS(run_bench("skip", true, options), InputError);
    }
}

TEST_CASE("the cases of the skip benchmark are scenes that this version reads, absent ones first", "[bench]")
{
    const ScratchFolder folder;
    const std::vector<SkipCase> cases = skip_cases(9, 0.1, folder.path("").substr(0, folder.path("").size() - 1));
    CHECK(cases.size() > 20);
    std::string feature;
    for (const SkipCase& one : cases) {
        INFO(one.feature << ' ' << one.state);
        CHECK((one.feature == feature || one.state == "absent"));
        feature = one.feature;
        CHECK_NOTHROW(read_scene(one.scene, {}));
    }
}
