#include "host/solver/state/topology.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace selvage {
namespace {

// Union-find over sewn vertices; the smallest vertex stands for its group, so numbering stays local.
std::vector<int> sewn_groups(const Cloth& cloth, const std::vector<char>& welded)
{
    std::vector<int> parent(cloth.positions.size());
    std::iota(parent.begin(), parent.end(), 0);
    const auto root = [&](int v) {
        while (parent[v] != v) v = parent[v] = parent[parent[v]];
        return v;
    };
    for (std::size_t k = 0; k < welded.size(); ++k) {
        if (!welded[k]) continue;
        const int ra = root(cloth.seam_pairs[k][0]), rb = root(cloth.seam_pairs[k][1]);
        parent[std::max(ra, rb)] = std::min(ra, rb);
    }
    for (int v = 0; v < int(parent.size()); ++v) parent[v] = root(v);
    return parent;
}

struct HalfEdge {
    int low, high, face, opposite, first;
    bool operator<(const HalfEdge& o) const { return std::array{low, high, face} < std::array{o.low, o.high, o.face}; }
};

// An edge with exactly two faces is a hinge; free edges and edges where three layers meet have none.
void find_hinges(Topology& topology)
{
    std::vector<HalfEdge> edges;
    edges.reserve(3 * topology.faces.size());
    for (int f = 0; f < int(topology.faces.size()); ++f)
        for (int k = 0; k < 3; ++k) {
            const Face& face = topology.faces[f];
            const int a = face[k], b = face[(k + 1) % 3];
            edges.push_back({std::min(a, b), std::max(a, b), f, face[(k + 2) % 3], a});
        }
    std::sort(edges.begin(), edges.end());
    for (std::size_t i = 0; i < edges.size();) {
        std::size_t end = i + 1;
        while (end < edges.size() && edges[end].low == edges[i].low && edges[end].high == edges[i].high) ++end;
        const HalfEdge &one = edges[i], &two = edges[std::min(i + 1, edges.size() - 1)];
        if (end - i == 2 && one.opposite != two.opposite) {
            const int start = one.first, stop = one.first == one.low ? one.high : one.low;
            topology.hinges.push_back({start, stop, one.opposite, two.opposite});
            topology.hinge_faces.push_back({one.face, two.face});
        }
        i = end;
    }
}

}  // namespace

Topology make_topology(const Cloth& cloth, bool joined)
{
    return make_topology(cloth, std::vector<char>(joined ? cloth.seam_pairs.size() : 0, 1));
}

Topology make_topology(const Cloth& cloth, const std::vector<char>& welded)
{
    Topology topology;
    const int vertex_count = int(cloth.positions.size());
    topology.particle_of.resize(vertex_count);
    const std::vector<int> group = sewn_groups(cloth, welded);
    for (int v = 0; v < vertex_count; ++v)
        topology.particle_of[v] = group[v] == v ? topology.particle_count++ : topology.particle_of[group[v]];
    topology.faces.reserve(cloth.faces.size());
    for (const Face& f : cloth.faces)
        topology.faces.push_back({topology.particle_of[f[0]], topology.particle_of[f[1]], topology.particle_of[f[2]]});
    find_hinges(topology);
    for (const auto& [a, b] : cloth.seam_pairs)
        if (const int p = topology.particle_of[a], q = topology.particle_of[b]; p != q)
            topology.stitches.push_back({p, q});
    return topology;
}

std::vector<char> coarser_welds(const Cloth& fine, const std::vector<char>& welded, const Cloth& coarse)
{
    std::vector<char> result(coarse.seam_pairs.size());
    for (std::size_t s = 0; s < std::min(welded.empty() ? 0 : fine.seams.size(), coarse.seams.size()); ++s) {
        const Seam &from = fine.seams[s], &to = coarse.seams[s];
        if (from.pair_count == 0) continue;
        for (int k = 0; k < to.pair_count; ++k) {
            const double place = to.pair_count > 1 ? double(k) / (to.pair_count - 1) : 0.5;
            const int at = int(std::lround(place * (from.pair_count - 1)));
            result[to.first_pair + k] = welded[from.first_pair + at];
        }
    }
    return result;
}

mesh_sizes topology_sizes(const Topology& topology, int material_count, int coupling_count)
{
    mesh_sizes size{};
    size.vertex_count = topology.particle_count;
    size.face_count = int(topology.faces.size());
    size.hinge_count = int(topology.hinges.size());
    size.stitch_count = int(topology.stitches.size());
    size.spring_count = int(topology.springs.size());
    size.material_count = material_count;
    size.face_slot_count = 3 * size.face_count;
    size.hinge_slot_count = 4 * size.hinge_count;
    size.stitch_slot_count = 2 * size.stitch_count;
    size.coupling_count = coupling_count;
    size.spring_slot_count = 2 * size.spring_count;
#define STRIDE(kind) size.kind##_stride = padded_stride(size.kind##_count);
    ITEM_KINDS(STRIDE)
#undef STRIDE
    return size;
}

}  // namespace selvage
