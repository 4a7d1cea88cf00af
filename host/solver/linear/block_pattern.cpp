#include <algorithm>
#include <numeric>

#include "host/parallel/launch.hpp"
#include "host/solver/linear/linear_solver.hpp"

namespace selvage {
namespace {

// One kind of elements: its gather lists and its corners, as far as the pattern needs them.
struct Kind {
    const std::vector<int>& slots;
    const std::vector<int>& slot;
    const std::vector<int>& vertex;
    int corners, stride;
    std::vector<std::uint16_t>& place;
};

template <class Visit>
void visit_neighbours(const Kind& kind, int row, int vertex_stride, const Visit& visit)
{
    if (kind.slots.empty()) return;
    for (int s = kind.slots[row]; s < kind.slots[vertex_stride + row]; ++s)
        for (int corner = 0; corner < kind.corners; ++corner)
            visit(s, corner, kind.vertex[corner * kind.stride + (kind.slot[s] >> 2)]);
}

}  // namespace

BlockPattern make_pattern(const State& state)
{
    const int n = state.size.vertex_count, vs = state.size.vertex_stride;
    BlockPattern pattern;
    const Kind kinds[] = {
#define KIND(kind, corner_count)                                        \
    {state.kind##_slots, state.kind##_slot,        state.kind##_vertex, \
     corner_count,       state.size.kind##_stride, pattern.kind##_place},
        ELEMENT_KINDS(KIND)
#undef KIND
    };
    for (const Kind& kind : kinds) kind.place.resize(kind.slot.size() * std::size_t(kind.corners));

    std::vector<std::vector<int>> columns(n);
    tbb::parallel_for(tbb::blocked_range<int>(0, n, items_per_task), [&](const auto& range) {
        for (int row = range.begin(); row < range.end(); ++row) {
            std::vector<int>& own = columns[row];
            own.push_back(row);
            for (const Kind& kind : kinds)
                visit_neighbours(kind, row, vs, [&](int, int, int vertex) { own.push_back(vertex); });
            std::sort(own.begin(), own.end());
            own.erase(std::unique(own.begin(), own.end()), own.end());
            for (const Kind& kind : kinds)
                visit_neighbours(kind, row, vs, [&](int s, int corner, int vertex) {
                    const auto at = std::lower_bound(own.begin(), own.end(), vertex) - own.begin();
                    kind.place[std::size_t(kind.corners) * s + corner] = std::uint16_t(at);
                });
        }
    });
    pattern.row_begin.assign(1, 0);
    for (const std::vector<int>& own : columns) {
        pattern.column.insert(pattern.column.end(), own.begin(), own.end());
        pattern.row_begin.push_back(int(pattern.column.size()));
    }
    return pattern;
}

Prolongation particle_prolongation(const Prolongation& prolongation, const Topology& coarse, const Topology& fine)
{
    Prolongation result;
    result.offset.assign(1, 0);
    int next = 0;
    for (int v = 0; v < int(fine.particle_of.size()); ++v) {
        if (fine.particle_of[v] != next) continue;  // a sewn vertex whose particle has its row already
        ++next;
        for (int k = prolongation.offset[v]; k < prolongation.offset[v + 1]; ++k) {
            const int column = coarse.particle_of[prolongation.column[k]];
            const auto first = result.column.begin() + result.offset.back();
            const auto at = std::find(first, result.column.end(), column);
            if (at != result.column.end()) {
                result.weight[at - result.column.begin()] += prolongation.weight[k];
            } else {
                result.column.push_back(column);
                result.weight.push_back(prolongation.weight[k]);
            }
        }
        result.offset.push_back(int(result.column.size()));
    }
    return result;
}

}  // namespace selvage
