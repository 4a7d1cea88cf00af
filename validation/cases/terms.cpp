// Every term's force and stiffness against central differences, on a crumpled cloth.
#include <algorithm>
#include <cmath>

#include "host/solver/terms/unit_strengths.hpp"
#include "validation/cases/cases.hpp"
#include "validation/measure/finite_differences.hpp"
#include "validation/measure/small_cloth.hpp"

namespace selvage {

void check_terms(CaseReport& report)
{
    report.from("central differences of the term's own energy and force");
    const Params params = unit_strengths();
    for (const Term& term : all_terms()) {
        State state = crumpled_state(params);
        const std::vector<real> force = term_force(term, state, params);
        const std::vector<real> expected = differenced_force(term, state, params);
        double largest = 0, off = 0;
        for (const int dof : active_dofs(state)) {
            largest = std::max(largest, std::abs(expected[dof]));
            off = std::max(off, std::abs(force[dof] - expected[dof]));
        }
        const std::string name(term.name);
        report.absolute(name + ": force, largest difference over largest force", 0, off / largest, 1e-5);
        const Eigen::MatrixXd stiffness = ordered_stiffness(term, state, params, false);
        const Eigen::MatrixXd differences = differenced_stiffness(term, state, params);
        report.absolute(name + ": exact stiffness, largest difference over norm", 0,
                        (stiffness - differences).cwiseAbs().maxCoeff() / std::max(differences.norm(), 1e-3), 2e-6);
    }
}

}  // namespace selvage
