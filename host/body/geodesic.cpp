#include "host/body/geodesic.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>
#include <utility>

namespace selvage {
namespace {

// Distance of corner c of a triangle whose corners a and b have theirs.
double distance_through(const Vec3& a, const Vec3& b, const Vec3& c, double from_a, double from_b)
{
    const Vec3 ab = b - a, ac = c - a;
    const double along_edges = std::min(from_a + ac.norm(), from_b + (c - b).norm());
    const double length = ab.norm();
    if (!(length > 0)) return along_edges;
    // Coordinates in the triangle's plane: a at the origin, b on the first axis, c above it, the source below it.
    const double cx = ac.dot(ab) / length, cy = std::sqrt(std::max(ac.squaredNorm() - cx * cx, 0.0));
    const double sx = (from_a * from_a - from_b * from_b + length * length) / (2 * length);
    const double below = from_a * from_a - sx * sx;
    if (below < 0 || !(cy > 0)) return along_edges;
    const double sy = std::sqrt(below);
    const double crossing = sx + (cx - sx) * sy / (cy + sy);
    if (crossing < 0 || crossing > length) return along_edges;
    return std::min(along_edges, std::hypot(cx - sx, cy + sy));
}

}  // namespace

std::vector<double> geodesic_distances(const Skin& skin, const std::vector<GeodesicSource>& sources)
{
    std::vector<double> distance(skin.smooth.size(), std::numeric_limits<double>::infinity());
    std::vector<char> settled(skin.smooth.size());
    using Waiting = std::pair<double, int>;
    std::priority_queue<Waiting, std::vector<Waiting>, std::greater<>> queue;
    const auto offer = [&](int vertex, double value) {
        if (settled[vertex] || !(value < distance[vertex])) return;
        distance[vertex] = value;
        queue.emplace(value, vertex);
    };
    for (const GeodesicSource& source : sources) offer(source.vertex, source.distance);
    while (!queue.empty()) {
        const auto [reached, v] = queue.top();
        queue.pop();
        if (settled[v]) continue;
        settled[v] = 1;
        for (const int f : skin.faces_of(v)) {
            const Face& face = skin.faces[f];
            const int k = face[0] == v ? 0 : face[1] == v ? 1 : 2;
            const int one = face[(k + 1) % 3], two = face[(k + 2) % 3];
            const Vec3 &x = skin.smooth[v], &y = skin.smooth[one], &z = skin.smooth[two];
            offer(one, settled[two] ? distance_through(x, z, y, reached, distance[two]) : reached + (y - x).norm());
            offer(two, settled[one] ? distance_through(x, y, z, reached, distance[one]) : reached + (z - x).norm());
        }
    }
    return distance;
}

}  // namespace selvage
