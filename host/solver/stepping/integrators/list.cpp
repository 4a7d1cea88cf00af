#include "host/solver/stepping/integrators/list.hpp"

#include <string>

#include "io/errors.hpp"

namespace selvage {

std::span<const IntegratorInfo> integrators()
{
#define INTEGRATOR(name, word, order, is_explicit, error_power, summary) \
    {word, summary, order, is_explicit, error_power},
    static const IntegratorInfo infos[] = {INTEGRATORS(INTEGRATOR)};
#undef INTEGRATOR
    return infos;
}

std::unique_ptr<Integrator> make_integrator(std::string_view wanted, Phase& phase)
{
    std::vector<std::string> names;
    for (const IntegratorInfo& info : integrators()) {
        names.emplace_back(info.name);
        if (info.name != wanted) continue;
#define INTEGRATOR(name, word, order, is_explicit, error_power, summary) \
    if (wanted == word) return make_##name##_integrator(phase, info);
        INTEGRATORS(INTEGRATOR)
#undef INTEGRATOR
    }
    throw InputError({{}, 0, 0, "solver.integrator"}, "`" + std::string(wanted) + "`", "an integrator",
                     nearest_name(wanted, names));
}

}  // namespace selvage
