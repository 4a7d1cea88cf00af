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

/// A distance as a float that is not below it, or not above it: rounding errs by 2^-24 of it.
inline float rounded_up(double x) { return float(x * (1 + 0x1p-23)); }
inline float rounded_down(double x) { return float(x * (1 - 0x1p-23)); }

/// Returns the weights of the corners in the way from the closest point of the second side to that of the first [1].
inline pair_weights closest_weights(const PairCorners& x, bool edges)
{
    const auto at = [&](int i) { return make_vec3(x[i].x(), x[i].y(), x[i].z()); };
    return edges ? closest_edge_edge(at(0), at(1), at(2), at(3)) : closest_point_face(at(0), at(1), at(2), at(3));
}

/// Returns the distance of the two sides [m].
inline double pair_distance(const PairCorners& x, bool edges)
{
    const pair_weights p = closest_weights(x, edges);
    return (p.w[1] * (x[1] - x[0]) + p.w[2] * (x[2] - x[0]) + p.w[3] * (x[3] - x[0])).norm();
}

/// Returns a bound of how far the two sides move against each other in a straight move of the corners [m].
inline double pair_approach(const PairCorners& move, bool edges)
{
    const Vec3 mean = 0.25 * (move[0] + move[1] + move[2] + move[3]);
    std::array<double, 4> way{};
    for (int i = 0; i < 4; ++i) way[i] = (move[i] - mean).norm();
    return edges ? std::max(way[0], way[1]) + std::max(way[2], way[3]) : way[0] + std::max({way[1], way[2], way[3]});
}

/// Returns how much of a straight move the pair can make without coming nearer than `least`; at most 1. Never too
/// large: the bound of the approach holds for every part of the move. Source: additive continuous collision detection,
/// Li and others 2021 (C-IPC), algorithm 1.
/// @param distance  at the start [m], > least > 0    @param approach  pair_approach of the move [m]
/// @param enough    1 is returned as soon as at least this part is found to be free
inline double free_fraction(PairCorners x, const PairCorners& move, bool edges, double distance, double approach,
                            double least, double enough = 1)
{
    const Vec3 mean = 0.25 * (move[0] + move[1] + move[2] + move[3]);
    const double close = 0.02 * (distance - least);  // of what there is to lose: who moves apart is not stopped
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
