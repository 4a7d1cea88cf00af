#pragma once
#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Geometry>

#include "io/geometry.hpp"
#include "kernels/closest.h"

namespace selvage {

/// The corners of a pair: a vertex and a face's three, or the ends of two edges.
using PairCorners = std::array<Vec3, 4>;

/// Return a float that is not below, or not above, a distance; the relative error of rounding is at most 2^-24.
inline float rounded_up(double x) { return float(x * (1 + 0x1p-23)); }
inline float rounded_down(double x) { return float(x * (1 - 0x1p-23)); }

/// Returns the weights of the corners in the vector from the closest point of the second primitive to that of
/// the first [1].
inline pair_weights closest_weights(const PairCorners& x, bool edges)
{
    const auto at = [&](int i) { return make_vec3(x[i].x(), x[i].y(), x[i].z()); };
    return edges ? closest_edge_edge(at(0), at(1), at(2), at(3)) : closest_point_face(at(0), at(1), at(2), at(3));
}

/// Returns the vector from the closest point of the second primitive to that of the first [m].
inline Vec3 pair_difference(const PairCorners& x, bool edges)
{
    const pair_weights p = closest_weights(x, edges);
    return p.w[1] * (x[1] - x[0]) + p.w[2] * (x[2] - x[0]) + p.w[3] * (x[3] - x[0]);
}

/// Returns the distance between the two primitives [m].
inline double pair_distance(const PairCorners& x, bool edges) { return pair_difference(x, edges).norm(); }

/// Returns an upper bound of how far the two primitives approach each other when their corners move straight [m]. The
/// mean motion of the corners is left out, since it changes no distance.
inline double pair_approach(const PairCorners& move, bool edges)
{
    const Vec3 mean = 0.25 * (move[0] + move[1] + move[2] + move[3]);
    std::array<double, 4> moved{};
    for (int i = 0; i < 4; ++i) moved[i] = (move[i] - mean).norm();
    return edges ? std::max(moved[0], moved[1]) + std::max(moved[2], moved[3])
                 : moved[0] + std::max({moved[1], moved[2], moved[3]});
}

/// Returns a lower bound of the distance of the two primitives during the whole of a straight move [m]; not above zero
/// if none is found. Sides that are apart along an axis, in the same order at both ends of the move, are no nearer to
/// each other in between, however far they go: the lowest coordinate of a side is a concave function of time, and the
/// highest a convex one. Axes are those of the coordinates, as for the boxes of a tree, and the one along which the
/// sides are apart at the start.
/// @param difference  pair_difference at the start [m]
inline double kept_apart(const PairCorners& x, const PairCorners& move, bool edges, const Vec3& difference)
{
    using Coordinates = Eigen::Array4d;  // x, y, z and along the difference
    const double length = difference.norm();
    const Vec3 axis = length > 0 ? Vec3(difference / length) : Vec3(Vec3::Zero());
    const auto coordinates = [&](const Vec3& of) { return Coordinates(of.x(), of.y(), of.z(), axis.dot(of)); };
    const int first = edges ? 2 : 1;
    Coordinates above = Coordinates::Constant(1e300), below = above;
    for (int end = 0; end < 2; ++end) {
        std::array<Coordinates, 4> at;
        for (int i = 0; i < 4; ++i)
            at[i] = coordinates(end == 0 ? Vec3(x[i] - x[0]) : Vec3(x[i] - x[0] + move[i] - move[0]));
        Coordinates low[2] = {at[0], at[first]}, high[2] = {at[0], at[first]};
        for (int i = 1; i < 4; ++i) {
            const int side = i >= first;
            low[side] = low[side].min(at[i]);
            high[side] = high[side].max(at[i]);
        }
        above = above.min(low[0] - high[1]);
        below = below.min(low[1] - high[0]);
    }
    return above.max(below).maxCoeff();
}

/// Returns the fraction of a straight move that the pair can make without coming nearer than `least`; at most 1. The
/// fraction is conservative, since the bound of the approach holds for every part of the move. Source: additive
/// continuous collision detection, Li and others 2021 (C-IPC), algorithm 1.
/// @param distance  at the start [m], > least > 0    @param approach  pair_approach of the move [m]
/// @param enough    the result is 1 as soon as at least this fraction is found to be free
inline double free_fraction(PairCorners x, const PairCorners& move, bool edges, double distance, double approach,
                            double least, double enough = 1)
{
    const Vec3 mean = 0.25 * (move[0] + move[1] + move[2] + move[3]);
    // The iteration stops when the distance is close to `least`, which never happens to a pair that moves apart. Two
    // percent were chosen by hand; the unit test of head-on moves checks that nearly the whole free fraction is found.
    const double close = 0.02 * (distance - least);
    double done = 0;
    for (int iteration = 0; iteration < 200; ++iteration) {
        const double step = (distance - least) / approach;
        if (done + step >= enough) return 1;
        done += step;
        for (int i = 0; i < 4; ++i) x[i] += step * (move[i] - mean);
        distance = pair_distance(x, edges);
        if (!(distance - least > close)) break;
    }
    return done;
}

}  // namespace selvage
