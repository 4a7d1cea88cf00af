#include <algorithm>
#include <random>

#include "host/collision/ccd.hpp"
#include "validation/unit/catch.hpp"

using namespace selvage;

namespace {

constexpr double keep = 0.1;

struct MovingPair {
    bool edges;
    PairCorners x, move;
};

class Corners {
public:
    explicit Corners(unsigned seed) : random_(seed) {}
    double number() { return uniform_(random_); }
    Vec3 point() { return {number(), number(), number()}; }
    PairCorners pair() { return {point(), point(), point(), point()}; }
    // Of edges in every other trial. @param longest  the moves are up to this long in each direction
    MovingPair moving_pair(int trial, double longest)
    {
        MovingPair moving{bool(trial % 2), pair(), pair()};
        for (Vec3& u : moving.move) u *= longest;
        return moving;
    }

private:
    std::mt19937 random_;
    std::uniform_real_distribution<double> uniform_{-1, 1};
};

// Returns the least distance between the points of a lattice on either side.
double sampled_distance(const PairCorners& x, bool edges, int steps = 120)
{
    double least = 1e30;
    for (int i = 0; i <= steps; ++i)
        for (int j = 0; j <= (edges ? steps : steps - i); ++j) {
            const double s = double(i) / steps, t = double(j) / steps;
            const Vec3 a = edges ? Vec3(x[0] + s * (x[1] - x[0])) : x[0];
            const Vec3 b = edges ? Vec3(x[2] + t * (x[3] - x[2])) : Vec3(x[1] + s * (x[2] - x[1]) + t * (x[3] - x[1]));
            least = std::min(least, (a - b).norm());
        }
    return least;
}

double longest_side(const PairCorners& x)
{
    return std::max({(x[1] - x[0]).norm(), (x[2] - x[1]).norm(), (x[3] - x[2]).norm(), (x[3] - x[1]).norm()});
}

pair_weights weights(const PairCorners& x, bool edges)
{
    const auto at = [&](int i) { return make_vec3(x[i].x(), x[i].y(), x[i].z()); };
    return edges ? closest_edge_edge(at(0), at(1), at(2), at(3)) : closest_point_face(at(0), at(1), at(2), at(3));
}

// Checks that the closest points belong to the two sides, that no pair of samples is closer, and that one is nearly as
// close, since the samples are dense. Edges whose angle has a sine below 1e-6 are treated as parallel; the error of
// that is at most `parallel_sine` times their length.
void check_closest(const PairCorners& x, bool edges, double parallel_sine = 0)
{
    const pair_weights p = weights(x, edges);
    const double least = -1e-12;
    CHECK(std::abs(p.w[0] + p.w[1] + p.w[2] + p.w[3]) <= 1e-12);
    for (int i = 0; i < 4; ++i) CHECK((i < (edges ? 2 : 1) ? p.w[i] : -p.w[i]) >= least);
    CHECK(p.w[0] + (edges ? p.w[1] : 0) == Approx(1));
    const double distance = pair_distance(x, edges), sampled = sampled_distance(x, edges);
    CHECK(distance <= sampled + 1e-12 + parallel_sine * longest_side(x));
    CHECK(distance >= sampled - 1.5 * longest_side(x) / 120);
}

PairCorners at(const PairCorners& x, const PairCorners& move, double part)
{
    PairCorners moved;
    for (int i = 0; i < 4; ++i) moved[i] = x[i] + part * move[i];
    return moved;
}

double free_part(const PairCorners& x, const PairCorners& move, bool edges)
{
    const double distance = pair_distance(x, edges);
    return free_fraction(x, move, edges, distance, pair_approach(move, edges), keep * distance);
}

}  // namespace

TEST_CASE("no point of a face is closer to a vertex than its closest point", "[closest]")
{
    Corners corners(1);
    for (int trial = 0; trial < 150; ++trial) check_closest(corners.pair(), false);
}

TEST_CASE("no points of two edges are closer than their closest points", "[closest]")
{
    Corners corners(2);
    for (int trial = 0; trial < 60; ++trial) check_closest(corners.pair(), true);
}

TEST_CASE("closest points of slivers and of parallel and nearly parallel edges are right", "[closest]")
{
    Corners corners(3);
    for (int trial = 0; trial < 60; ++trial) {
        PairCorners x = corners.pair();
        x[3] = x[1] + (0.5 + 0.5 * corners.number()) * (x[2] - x[1]) + 1e-7 * corners.point();  // a sliver
        INFO("sliver " << trial);
        check_closest(x, false);
        for (double off : {0.0, 1e-9, 1e-6, 1e-3}) {
            PairCorners edges = corners.pair();
            edges[3] = edges[2] + corners.number() * 2 * (edges[1] - edges[0]) + off * corners.point();
            INFO("parallel " << trial << " off by " << off);
            check_closest(edges, true, 1e-6);
        }
    }
}

TEST_CASE("the closest point of a face is a corner, on an edge or inside, depending on where the vertex is",
          "[closest]")
{
    const PairCorners face{Vec3(-1, -1, 1), Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)};
    const auto expect = [&](const Vec3& x, double a, double b, double c) {
        PairCorners pair = face;
        pair[0] = x;
        const pair_weights p = weights(pair, false);
        CHECK(p.w[1] == Approx(-a).margin(1e-14));
        CHECK(p.w[2] == Approx(-b).margin(1e-14));
        CHECK(p.w[3] == Approx(-c).margin(1e-14));
    };
    expect({-1, -1, 1}, 1, 0, 0);
    expect({2, -0.5, 1}, 0, 1, 0);
    expect({-0.5, 2, 1}, 0, 0, 1);
    expect({0.25, -1, 3}, 0.75, 0.25, 0);
    expect({-2, 0.5, 0}, 0.5, 0, 0.5);
    expect({1, 1, -1}, 0, 0.5, 0.5);
    expect({0.2, 0.3, 5}, 0.5, 0.2, 0.3);
}

TEST_CASE("a point has a place in the plane of a face that has no area", "[closest]")
{
    for (real corner : {0.0, 0.5, 1.0}) {
        const pair_weights p =
            closest_point_plane(make_vec3(0.25, 1, 0), make_vec3(0, 0, 0), make_vec3(1, 0, 0), make_vec3(corner, 0, 0));
        double sum = 0;
        for (double w : p.w) {
            REQUIRE(std::isfinite(w));
            sum += w;
        }
        CHECK(sum == Approx(0).margin(1e-14));
    }
}

TEST_CASE("on the free fraction of a move no pair comes nearer than the distance to keep", "[closest]")
{
    Corners corners(4);
    int cut = 0;
    for (int trial = 0; trial < 400; ++trial) {
        const auto [edges, x, move] = corners.moving_pair(trial, 3);
        const double distance = pair_distance(x, edges), part = free_part(x, move, edges);
        REQUIRE(part > 0);
        REQUIRE(part <= 1);
        cut += part < 1;
        double least = 1e30;
        for (int k = 0; k <= 400; ++k) least = std::min(least, pair_distance(at(x, move, part * k / 400), edges));
        CHECK(least >= keep * distance * (1 - 1e-9));
    }
    CHECK(cut > 40);
}

TEST_CASE("a head-on approach is free for at least 85 % of the allowed distance", "[closest]")
{
    Corners corners(5);
    for (int trial = 0; trial < 100; ++trial) {
        const double height = 0.5 + 0.4 * corners.number(), length = height * (3 + corners.number());
        const PairCorners face{Vec3(0.3, 0.3, height), Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)};
        const PairCorners edges{Vec3(-1, 0, height), Vec3(1, 0, height), Vec3(0, -1, 0), Vec3(0, 1, 0)};
        const Vec3 down(0, 0, -length), none = Vec3::Zero();
        const double allowed = (1 - keep) * height / length;
        for (double shift : {0.0, 5.0}) {  // a common displacement of both sides must not matter
            const Vec3 common(shift, -shift, 2 * shift);
            const double of_face = free_part(face, {down + common, none + common, none + common, none + common}, false);
            const double of_edges =
                free_part(edges, {down + common, down + common, none + common, none + common}, true);
            for (double part : {of_face, of_edges}) {
                CHECK(part <= allowed * (1 + 1e-9));
                CHECK(part >= 0.85 * allowed);
            }
        }
    }
}

TEST_CASE("a move along or away from the other side is free", "[closest]")
{
    const PairCorners x{Vec3(0.3, 0.3, 0.01), Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)};
    const Vec3 none = Vec3::Zero();
    CHECK(free_part(x, {Vec3(0, 0, 0.5), none, none, none}, false) == 1);
    CHECK(free_part(x, {Vec3(0.3, 0.3, 0), none, none, none}, false) == 1);
    CHECK(free_part(x, {none, none, none, none}, false) == 1);
}

TEST_CASE("two primitives stay as far apart during a move as is told at its start", "[closest]")
{
    Corners corners(6);
    int kept = 0;
    for (int trial = 0; trial < 400; ++trial) {
        const auto [edges, x, move] = corners.moving_pair(trial, trial % 3);
        const double apart = kept_apart(x, move, edges, pair_difference(x, edges));
        kept += apart > 0;
        for (int k = 0; k <= 100; ++k) CHECK(pair_distance(at(x, move, k / 100.0), edges) >= apart - 1e-12);
        PairCorners common;  // what both sides have in common brings them no nearer
        common.fill(Vec3(5, -3, 2));
        CHECK(kept_apart(x, common, edges, pair_difference(x, edges)) >= pair_distance(x, edges) * (1 - 1e-9));
    }
    CHECK(kept > 100);
}
