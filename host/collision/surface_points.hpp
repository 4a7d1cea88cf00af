#pragma once
#include <vector>

#include "host/parallel/launch.hpp"
#include "io/geometry.hpp"

namespace selvage {

/// The points of a mesh: its vertices, those at one place being one, with their normals and neighbours.
struct SurfacePoints {
    std::vector<int> point_of;  ///< Vertex to point.
    std::vector<Vec3> points, normals;
    std::vector<int> begin, ring;  ///< Neighbours of point k: ring[begin[k]] to ring[begin[k + 1] - 1].
};

SurfacePoints surface_points(const TriangleMesh& mesh);

/// How thick a body is at the points of its surface.
struct Thickness {
    std::vector<double> radii;     ///< Of the largest ball within that touches each point [m].
    std::vector<char> sticks_out;  ///< The point belongs to what is far thinner than what it stands on, as ears do.
};

/// Returns the thickness by the shrinking-ball method of Ma, Bae and Choi 2012. What sticks out has the radii of what
/// it stands on.
Thickness thickness_of(const SurfacePoints& surface);

/// Replaces each value, or those that are marked, by what `blend` makes of it and the mean around it.
template <class Value, class Blend>
void smooth(const SurfacePoints& surface, std::vector<Value>& values, int rounds, const Blend& blend,
            const std::vector<char>* marked = nullptr)
{
    std::vector<Value> next = values;
    for (int round = 0; round < rounds; ++round) {
        for_each_item(int(values.size()), [&, to = next.data(), from = values.data()](int k) {
            const int first = surface.begin[k], last = surface.begin[k + 1];
            if (first == last || (marked && !(*marked)[k])) return;
            Value mean = from[surface.ring[first]];
            for (int i = first + 1; i < last; ++i) mean += from[surface.ring[i]];
            to[k] = blend(from[k], Value(mean / double(last - first)));
        });
        values.swap(next);
    }
}

/// Gives marked points the values of the nearest others along the surface, and smooths those.
template <class Value>
void take_from_around(const SurfacePoints& surface, const std::vector<char>& marked, std::vector<Value>& values)
{
    constexpr int carry_rounds = 50;  // of smoothing: across a hand's breadth of a body's mesh; chosen by hand
    std::vector<char> waits = marked;
    std::vector<int> front;
    for (int k = 0; k < int(values.size()); ++k)
        if (!waits[k]) front.push_back(k);
    while (!front.empty()) {
        std::vector<int> next;
        for (int k : front)
            for (int i = surface.begin[k]; i < surface.begin[k + 1]; ++i) {
                const int other = surface.ring[i];
                if (!waits[other]) continue;
                waits[other] = 0;
                values[other] = values[k];
                next.push_back(other);
            }
        front.swap(next);
    }
    smooth(
        surface, values, carry_rounds, [](const Value&, const Value& mean) { return mean; }, &marked);
}

}  // namespace selvage
