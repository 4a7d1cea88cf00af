#include "host/body/merge_tree.hpp"

#include <algorithm>
#include <cmath>

namespace selvage {
namespace {

// Sets of vertices, each of which knows its highest one; -1: the sweep has not come to the vertex.
class SweptSets {
public:
    explicit SweptSets(std::size_t count) : parent_(count, -1) {}
    bool has(int vertex) const { return parent_[vertex] >= 0; }
    void add(int vertex) { parent_[vertex] = vertex; }
    int top(int vertex)
    {
        while (parent_[vertex] != vertex) vertex = parent_[vertex] = parent_[parent_[vertex]];
        return vertex;
    }
    void join(int lower_top, int higher_top) { parent_[lower_top] = higher_top; }

private:
    std::vector<int> parent_;
};

}  // namespace

std::vector<Branch> merge_tree(const Skin& skin, const std::vector<double>& values, double least)
{
    std::vector<int> order;
    for (int v = 0; v < int(values.size()); ++v)
        if (std::isfinite(values[v])) order.push_back(v);
    const auto higher = [&](int a, int b) { return values[a] != values[b] ? values[a] > values[b] : a < b; };
    std::sort(order.begin(), order.end(), higher);

    SweptSets sets(values.size());
    std::vector<Branch> branches;
    for (const int v : order) {
        sets.add(v);
        for (const int f : skin.faces_of(v))
            for (const int near : skin.faces[f]) {
                if (near == v || !sets.has(near)) continue;
                int low = sets.top(v), high = sets.top(near);
                if (low == high) continue;
                if (higher(low, high)) std::swap(low, high);
                if (low != v && values[low] - values[v] >= least)
                    branches.push_back({low, v, high, values[low] - values[v]});
                sets.join(low, high);
            }
    }
    if (!order.empty()) branches.push_back({order[0], -1, -1, values[order.front()] - values[order.back()]});
    std::sort(branches.begin(), branches.end(), [&](const Branch& a, const Branch& b) { return higher(a.tip, b.tip); });
    return branches;
}

}  // namespace selvage
