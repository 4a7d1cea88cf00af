#include "validation/cases/cases.hpp"

#include <chrono>

#include <fmt/format.h>

#include "io/errors.hpp"

namespace selvage {

const std::vector<CaseGroup>& case_groups()
{
    static const std::vector<CaseGroup> groups = {
        {"stretch", "patch tests of the membrane: forces and energy of uniform strains", check_stretch},
        {"terms", "every term's force and stiffness against finite differences", check_terms},
        {"rigidity", "bending rigidity shown by six mesh families in five directions", check_rigidity},
        {"cantilever", "a heavy strip clamped at one end against the elastica", check_cantilever},
        {"catenary", "a strip hanging between two supports against the catenary", check_catenary},
        {"frequencies", "small vibrations of chains, membranes and strips", check_frequencies},
        {"buckling", "the load at which a clamped strip on edge turns over", check_buckling},
        {"motion", "rigid motions at every stiffness: pendulums, a card, free fall and spin", check_motion},
        {"integrators", "motion in time: frequencies, damping, orders and conserved quantities", check_integrators},
        {"friction", "Coulomb friction on an incline and around a cylinder", check_friction},
        {"wind", "air on cloth: falling sheets, plates, taut sheets and curtains in wind", check_wind},
        {"cusick", "Cusick's drape test: coefficients, folds and the influence of the mesh", check_cusick},
        {"doubling", "Cusick's drape test under doubled resolution", check_doubling},
    };
    return groups;
}

std::vector<ValidationRow> run_cases(const std::vector<std::string>& names, bool quick, const CaseProgress& progress)
{
    std::vector<std::string> known;
    for (const CaseGroup& group : case_groups()) known.push_back(group.name);
    for (const std::string& name : names)
        if (std::find(known.begin(), known.end(), name) == known.end())
            throw InputError({"", 0, 0, "CASE"}, "`" + name + "`", "a name that `selvage validate --list` prints",
                             nearest_name(name, known));
    std::vector<ValidationRow> rows;
    for (const CaseGroup& group : case_groups()) {
        if (!names.empty() && std::find(names.begin(), names.end(), group.name) == names.end()) continue;
        progress(group.name + ": " + group.summary);
        const auto start = std::chrono::steady_clock::now();
        CaseReport report(group.name, quick);
        try {
            group.run(report);
        } catch (const std::exception& error) {
            report.fail(error.what());
        }
        rows.insert(rows.end(), report.rows().begin(), report.rows().end());
        progress(fmt::format("{}: {} rows, {:.1f} s", group.name, report.rows().size(),
                             std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count()));
    }
    return rows;
}

}  // namespace selvage
