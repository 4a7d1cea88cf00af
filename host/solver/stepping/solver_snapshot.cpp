#include "host/solver/stepping/solver_snapshot.hpp"

#include "host/solver/stepping/phase.hpp"

namespace selvage {

void keep(const System& system, Integrator* integrator, SolverSnapshot& snapshot)
{
    keep(system.state(), snapshot.fields);
    if (system.cloth_contact()) {
        snapshot.pairs = system.cloth_contact()->memory();
        snapshot.crossings = system.cloth_contact()->crossings();
    }
    const auto arrays = integrator ? integrator->history() : std::vector<HistoryArray>{};
    snapshot.history.resize(arrays.size());
    for (std::size_t k = 0; k < arrays.size(); ++k) snapshot.history[k] = *arrays[k].values;
}

void restore(System& system, Integrator* integrator, const SolverSnapshot& snapshot)
{
    restore(system.state(), snapshot.fields);
    if (system.cloth_contact()) system.cloth_contact()->set_memory(snapshot.pairs);
    const auto arrays = integrator ? integrator->history() : std::vector<HistoryArray>{};
    for (std::size_t k = 0; k < arrays.size(); ++k) *arrays[k].values = snapshot.history[k];
}

void restore_crossings(System& system, const SolverSnapshot& snapshot)
{
    if (system.cloth_contact()) system.cloth_contact()->set_crossings(snapshot.crossings);
}

}  // namespace selvage
