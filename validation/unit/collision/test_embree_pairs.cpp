#include <algorithm>
#include <set>

#include "bench/suites/embree_pairs.hpp"
#include "host/solver/contact/cloth_surface.hpp"
#include "validation/measure/crumpled_sheets.hpp"
#include "validation/unit/catch.hpp"

using namespace selvage;

namespace {

constexpr double spacing = 0.02, gap = 0.3 * spacing;
constexpr int side = 13;

using Key = std::pair<bool, std::array<int, 4>>;

// Returns the pairs within the gap, with keys that do not depend on the order of their corners.
std::set<Key> close(const std::vector<PairCandidate>& candidates, const std::vector<Vec3>& x)
{
    std::set<Key> result;
    for (PairCandidate c : candidates) {
        if (!(pair_distance({x[c.corner[0]], x[c.corner[1]], x[c.corner[2]], x[c.corner[3]]}, c.edges) < gap)) continue;
        if (c.edges) {
            std::sort(c.corner.begin(), c.corner.begin() + 2);
            std::sort(c.corner.begin() + 2, c.corner.end());
            if (c.corner[2] < c.corner[0])
                std::swap_ranges(c.corner.begin(), c.corner.begin() + 2, c.corner.begin() + 2);
        } else {
            std::sort(c.corner.begin() + 1, c.corner.end());
        }
        CHECK(result.insert({c.edges, c.corner}).second);  // each pair is found only once
    }
    return result;
}

}  // namespace

TEST_CASE("ClothTree and the tree of the ray tracing library find the same pairs", "[tree]")
{
    const Cloth cloth = grid_cloth(side, side, spacing);
    const int stride = padded_stride(side * side);
    const TreeSurface surface = tree_surface(make_topology(cloth, false), cloth);
    const EmbreeDevice device;
    ClothTree own(surface, 0);
    std::mt19937 random(5);
    const std::vector<Vec3> no_bodies;
    for (EmbreePairs::Update update : {EmbreePairs::Update::refit, EmbreePairs::Update::rebuild}) {
        EmbreePairs rival(device, surface, update);
        for (double size : {0.0, 0.05, 0.1, 0.15}) {
            std::vector<Vec3> x = random_waves(cloth, size, spacing * side, random);
            for (std::size_t v = 0; v < x.size(); ++v) x[v] += cloth.positions[v];
            const std::vector<real> pos = as_planes(x, stride);
            rival.move(pos.data(), stride, gap);
            own.forget();
            own.cover(pos.data(), nullptr, stride, {no_bodies}, gap, gap);
            const std::set<Key> pairs = close(own.candidates(), x);
            CHECK(close(rival.candidates(), x) == pairs);
            CHECK(pairs.empty() == (size == 0));
        }
    }
}
