#include "host/body/bend.hpp"

#include <algorithm>
#include <numeric>

namespace selvage {
namespace {

// Both are chosen so that 1 mm of noise on GarmentCode's mean body moves knees and sides of the neck by 1 cm at most.
constexpr int smoothing = 12;    // the depth is averaged over the curve's length over this, to either side
constexpr double nearly = 0.85;  // of the greatest depth

std::vector<double> smoothed(const std::vector<double>& values)
{
    const int reach = int(values.size()) / smoothing, last = int(values.size()) - 1;
    std::vector<double> means;
    for (int k = 0; k <= last; ++k) {
        const int n = std::min({reach, k, last - k});
        means.push_back(std::accumulate(values.begin() + k - n, values.begin() + k + n + 1, 0.0) / (2 * n + 1));
    }
    return means;
}

}  // namespace

Bend find_bend(const std::vector<Vec2>& curve, BendSide side)
{
    Bend bend;
    if (curve.size() < 3 || curve.front() == curve.back()) return bend;
    const Vec2 along = (curve.back() - curve.front()).normalized();
    std::vector<double> depth;
    for (const Vec2& point : curve) {
        const Vec2 to = point - curve.front();
        const double left = along.x() * to.y() - along.y() * to.x();
        depth.push_back(side == BendSide::left ? left : -left);
    }
    depth = smoothed(depth);
    const auto furthest = std::max_element(depth.begin(), depth.end());
    if (!(*furthest > 0)) return bend;
    bend.depth = *furthest;
    bend.point = int(furthest - depth.begin());
    int first = bend.point, last = bend.point;
    while (first > 0 && depth[first - 1] > nearly * bend.depth) --first;
    while (last + 1 < int(depth.size()) && depth[last + 1] > nearly * bend.depth) ++last;
    bend.middle = (first + last) / 2;
    return bend;
}

}  // namespace selvage
