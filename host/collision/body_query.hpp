#pragma once
#include <memory>
#include <vector>

#include "host/collision/body_bvh.hpp"
#include "host/model/body.hpp"
#include "kernels/stages/analytic_bodies.h"

namespace selvage {

/// Where `BodyQuery::nearest` writes its answers: one contact plane per vertex, the gap being normal . x - offset.
/// A vertex without a contact gets body -1, a zero normal and the offset `no_contact_offset`.
struct ContactPlanes {
    int stride = 0;            ///< Between the component planes of `normal`.
    double* normal = nullptr;  ///< Unit, out of the body: component c of vertex v at [c * stride + v].
    double* offset = nullptr;  ///< [m], one per vertex.
    int* body = nullptr;       ///< Index of the body, one per vertex.
};

/// Makes the gap of a vertex without a contact larger than any real one [m].
inline constexpr double no_contact_offset = -1e9;

/// The first place at which a path enters a body.
struct BodyCrossing {
    int body = -1;          ///< -1: the path enters no body.
    int triangle = -1;      ///< Face of the body's mesh; -1 for the closed forms.
    double fraction = 2;    ///< Of the path, in [0, 1].
    double way_beyond = 0;  ///< Length of the path behind the entry [m].
};

/// Distances of a cloth to the bodies, exact for the triangulated meshes and the closed forms.
struct BodyGap {
    double max_penetration_m = 0;  ///< Depth of the deepest vertex, 0 if none is inside.
    double min_gap_m = 0;          ///< Smallest signed distance; infinite if there are no vertices or no bodies.
    int vertices_inside = 0;
};

struct BodyQueryCounts {
    long long made = 0;       ///< Vertex queries answered by a search.
    long long skipped = 0;    ///< Vertex queries answered by a lower bound of the distance.
    int triangles_used = 0;   ///< In the hierarchies now.
    int triangles_total = 0;  ///< Of all mesh bodies.
    int rebuilds = 0;         ///< How often the cloth left its reach.
};

/// Answers where a cloth is in relation to the bodies of a scene, which may move: they start where they are at time 0.
/// A mesh that moves rigidly is asked in its own frame, one that deforms has its hierarchy refitted.
/// Results do not depend on the thread count, nor on which queries were skipped.
class BodyQuery {
public:
    /// @param bodies  copied as far as needed; no device of the ray tracing library is made unless one is a mesh
    /// @param reach   where the cloth is expected; only triangles that touch it are searched. A cloth that leaves it
    ///                is noticed, and the reach is widened.
    BodyQuery(const std::vector<Body>& bodies, const Box& reach);
    ~BodyQuery();
    BodyQuery(BodyQuery&&) noexcept;
    BodyQuery& operator=(BodyQuery&&) noexcept;

    bool empty() const;  ///< No bodies: nothing needs to be asked.
    bool uses_embree() const;
    const BodyQueryCounts& counts() const;

    /// Finds for every vertex the contact plane of the nearest surface within the radius, over all bodies.
    /// Vertices inside a closed form have a contact however deep they are. The normal is the smooth one of
    /// BodySurface; of several bodies the one with the smallest signed distance counts.
    /// Vertices whose distance was once found to be large are not searched again before they have moved that far.
    /// @param position  3 planes, component c of vertex v at [c * stride + v] [m]
    /// @param radius    search radius [m], > 0
    /// @param planes    written for vertices 0 to count - 1
    void nearest(const double* position, int stride, int count, double radius, const ContactPlanes& planes);

    bool moves() const;         ///< A body moves at some time.
    double motion_end() const;  ///< Time after which all bodies stand still [s]; 0 if none moves.
    double time() const;        ///< At which the bodies are placed [s].

    /// Places all bodies where they are at a time [s].
    void move_to(double time);

    /// The longest time within `room`, halved as often as needed, in which no body's surface moves further than `way`.
    /// @param time, room  [s]   @param way  [m], > 0
    double longest_step(double time, double room, double way) const;

    /// Where the last `move_to` took a point that goes with the surface which the last `nearest` named for a vertex:
    /// rigidly, and as the closest point of the closest triangle where the body deforms. Without a contact, or where
    /// the body stands still, the point stays.
    Vec3 carried(int vertex, const Vec3& point) const;

    /// Velocity of that surface at a point over the last `move_to`, which ended `span` seconds after it began [m/s].
    Vec3 surface_velocity(int vertex, const Vec3& point, double span) const
    {
        return (carried(vertex, point) - point) / span;
    }

    /// Forgets all lower bounds; only speed depends on it, since bounds hold for positions that jumped as well.
    void forget();

    /// Finds for every vertex the first place at which its straight path from `from` to `to` enters a body. Where the
    /// last `move_to` moved the body, the path is that relative to it: `from` holds places before that move.
    std::vector<BodyCrossing> crossings(const double* from, const double* to, int stride, int count);

    /// Measures the true signed distances of all vertices, whatever the reach.
    BodyGap measure(const double* position, int stride, int count) const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace selvage
