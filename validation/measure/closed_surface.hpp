#pragma once
#include <algorithm>
#include <utility>
#include <vector>

#include "host/mesh/body_tessellation.hpp"
#include "io/geometry.hpp"

namespace selvage {

/// True if every directed edge is met by its reverse exactly once, coincident vertices counted as one.
inline bool is_closed(const TriangleMesh& mesh)
{
    const std::vector<int> vertex_of = first_coincident_vertex(mesh.vertices);
    std::vector<std::pair<int, int>> directed;
    for (const Face& f : mesh.faces)
        for (int k = 0; k < 3; ++k) {
            const int a = vertex_of[f[k]], b = vertex_of[f[(k + 1) % 3]];
            if (a != b) directed.emplace_back(a, b);
        }
    std::sort(directed.begin(), directed.end());
    if (std::adjacent_find(directed.begin(), directed.end()) != directed.end()) return false;
    return std::all_of(directed.begin(), directed.end(), [&](const auto& edge) {
        return std::binary_search(directed.begin(), directed.end(), std::pair(edge.second, edge.first));
    });
}

}  // namespace selvage
