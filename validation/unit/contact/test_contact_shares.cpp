#include <algorithm>

#include "host/solver/contact/contact_shares.hpp"
#include "validation/unit/catch.hpp"
#include "validation/unit/contact/small_stack.hpp"

using namespace selvage;

namespace {

constexpr double spacing = 0.02, height = 0.001, gap = 0.003;
constexpr int side = 5;

// What presses a vertex off a flat sheet of 5 x 5 vertices: the sum over all its faces, by share and direction.
struct Push {
    double up = 0;
    Vec3 aside = Vec3::Zero();
};

Push push_at(const Vec3& vertex)
{
    Cloth cloth = grid_cloth(side, side, spacing);
    const int v = int(cloth.positions.size());
    std::vector<real> x(std::size_t(3 * (v + 1)));
    for (int c = 0; c < 3; ++c) {
        for (int k = 0; k < v; ++k) x[c * (v + 1) + k] = cloth.positions[k][c];
        x[c * (v + 1) + v] = vertex[c];
    }
    const std::vector<Vec3> none;
    const StraightStep at{x, nullptr, v + 1, {none}};
    std::vector<int> piece(std::size_t(v) + 1);
    piece.back() = 1;
    const ContactShares shares(cloth.faces, piece);
    std::vector<PairCandidate> pairs;
    for (const Face& f : cloth.faces) {
        const PairCandidate pair{{v, f[0], f[1], f[2]}, false};
        if (pair_distance(at.start_of(pair), false) < gap) pairs.push_back(pair);
    }
    std::sort(pairs.begin(), pairs.end(), [](const auto& a, const auto& b) { return a.corner < b.corner; });
    const std::vector<ContactShares::Share> of = shares.of(pairs, at);
    Push push;
    for (std::size_t p = 0; p < pairs.size(); ++p) {
        const PairCorners corners = at.start_of(pairs[p]);
        const pair_weights weights = closest_weights(corners, false);
        Vec3 way = Vec3::Zero();
        for (int i = 0; i < 4; ++i) way += weights.w[i] * corners[i];
        const Vec3 direction = of[p].plane ? Vec3(0, 0, 1) : Vec3(way.normalized());
        push.up += of[p].part * direction.z();
        push.aside += of[p].part * Vec3(direction.x(), direction.y(), 0);
    }
    return push;
}

}  // namespace

TEST_CASE("a layer presses on a vertex above it once, straight up, wherever it is")
{
    for (const Vec3& place : {Vec3(0.033, 0.025, height), Vec3(0.04, 0.04, height), Vec3(0.04001, 0.04, height),
                              Vec3(0.03, 0.04, height), Vec3(0.0399, 0.0401, height), Vec3(0.05, 0.0401, height)}) {
        const Push push = push_at(place);
        INFO(place.transpose());
        CHECK(push.up == Approx(1));
        CHECK(push.aside.norm() < 1e-12);
    }
}

TEST_CASE("the rim of a layer does not push aside what is above it, but what is beside it")
{
    for (const Vec3& place : {Vec3(0, 0.025, height), Vec3(-1e-7, 0.03, height), Vec3(-0.0003, 0.033, height),
                              Vec3(0, 0, height), Vec3(-0.0002, -0.0003, height)}) {
        const Push push = push_at(place);
        INFO(place.transpose());
        CHECK(push.up == Approx(1).epsilon(0.01));
        CHECK(push.aside.norm() < 1e-12);
    }
    const Push beside = push_at({-height, 0.025, 0.1 * height});
    CHECK(beside.aside.x() < -0.9);
    // As it goes further out above the rim, support ends, and nowhere is there no barrier at all.
    double last = 1;
    for (double out = 0; out < 2.5 * height; out += 0.05 * height) {
        const Push push = push_at({-out, 0.025, height});
        CHECK(push.up + push.aside.norm() > 0);
        if (out < 0.9 * height) CHECK(push.up <= last + 1e-12);
        last = push.up;
    }
}
