#include "host/collision/cloth_crossings.hpp"

#include <algorithm>

namespace selvage {
namespace {

struct Neighbours {
    std::vector<int> first, vertex;   // of each particle, in compressed rows

    Neighbours(const std::vector<Face>& faces, int particle_count)
    {
        std::vector<std::array<int, 2>> ends;
        ends.reserve(6 * faces.size());
        for (const Face& face : faces)
            for (int k = 0; k < 3; ++k) {
                ends.push_back({face[k], face[(k + 1) % 3]});
                ends.push_back({face[(k + 1) % 3], face[k]});
            }
        std::sort(ends.begin(), ends.end());
        ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
        first.assign(std::size_t(particle_count) + 1, 0);
        for (const auto& [from, to] : ends) {
            ++first[std::size_t(from) + 1];
            vertex.push_back(to);
        }
        for (std::size_t v = 1; v < first.size(); ++v) first[v] += first[v - 1];
    }
};

double volume(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) { return (b - a).cross(c - a).dot(d - a); }

// Touching counts: whoever asks wants to be sure of the opposite.
bool passes_through(const Vec3& p, const Vec3& q, const std::array<Vec3, 3>& face)
{
    const double sides = volume(face[0], face[1], face[2], p) * volume(face[0], face[1], face[2], q);
    if (sides > 0) return false;
    const double around[] = {volume(p, q, face[0], face[1]), volume(p, q, face[1], face[2]), volume(p, q, face[2], face[0])};
    return (around[0] >= 0 && around[1] >= 0 && around[2] >= 0) || (around[0] <= 0 && around[1] <= 0 && around[2] <= 0);
}

}  // namespace

int count_crossings(const TreeSurface& surface, const double* position, int stride, int particle_count)
{
    const auto at = [=](int v) { return Vec3(position[v], position[stride + v], position[2 * stride + v]); };
    double longest = 0;
    for (const Face& face : surface.faces)
        for (int k = 0; k < 3; ++k) longest = std::max(longest, (at(face[k]) - at(face[(k + 1) % 3])).norm());
    // An edge that passes through a face has both ends within its own length of it.
    ClothTree tree(surface, 0);
    tree.cover(position, nullptr, stride, {}, {}, longest);
    std::vector<std::array<int, 5>> crossings;   // edge, smaller end first, and face
    const Neighbours neighbours(surface.faces, particle_count);
    for (const PairCandidate& pair : tree.candidates()) {
        if (pair.edges) continue;
        const auto [v, a, b, c] = pair.corner;
        for (int k = neighbours.first[std::size_t(v)]; k < neighbours.first[std::size_t(v) + 1]; ++k) {
            const int w = neighbours.vertex[std::size_t(k)];
            if (w == a || w == b || w == c || !passes_through(at(v), at(w), {at(a), at(b), at(c)})) continue;
            crossings.push_back({std::min(v, w), std::max(v, w), a, b, c});
        }
    }
    std::sort(crossings.begin(), crossings.end());
    return int(std::unique(crossings.begin(), crossings.end()) - crossings.begin());
}

}  // namespace selvage
