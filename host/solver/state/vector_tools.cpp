#include "host/solver/state/vector_tools.hpp"

#include <cmath>

#include "host/parallel/launch.hpp"

namespace selvage {

double largest_distance(const State& state, const std::vector<real>& a, const std::vector<real>& b)
{
    const int vs = state.size.vertex_stride;
    return std::sqrt(max_items(state.size.vertex_count, [vs, x = a.data(), y = b.data()](int v) {
        const double dx = x[v] - y[v], dy = x[vs + v] - y[vs + v], dz = x[2 * vs + v] - y[2 * vs + v];
        return dx * dx + dy * dy + dz * dz;
    }));
}

bool is_finite(const State& state)
{
    return std::isfinite(sum_items(int(state.pos.size()), [x = state.pos.data(), v = state.vel.data()](int i) {
        return std::abs(x[i]) + std::abs(v[i]);
    }));
}

}  // namespace selvage
