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

/// Makes the gap of a vertex without a contact larger than any real gap [m].
inline constexpr double no_contact_offset = -1e9;

/// The first place at which a path enters a body.
struct BodyCrossing {
    int body = -1;          ///< -1: the path enters no body.
    int triangle = -1;      ///< Face of the body's mesh; -1 for the closed forms.
    double fraction = 2;    ///< Of the path, in [0, 1].
    double way_beyond = 0;  ///< Length of the path beyond the entry [m].
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
    int rebuilds = 0;         ///< How often the cloth left the reach.
};

/// Finds the contacts of a cloth's vertices with the bodies of a scene and the entries of their paths into the
/// bodies. Bodies may move; they start as they are at time 0. A mesh that moves rigidly is queried in its own
/// frame, and one that deforms has its hierarchy refitted. Results depend neither on the thread count nor on which
/// queries were skipped.
class BodyQuery {
public:
    /// @param bodies  copied as far as needed; the ray tracing library is started only if one of them is a mesh
    /// @param reach   box in which the cloth is expected; only triangles that touch it are searched. It is enlarged
    ///                when the cloth leaves it.
    BodyQuery(const std::vector<Body>& bodies, const Box& reach);
    ~BodyQuery();
    BodyQuery(BodyQuery&&) noexcept;
    BodyQuery& operator=(BodyQuery&&) noexcept;

    bool empty() const;  ///< True without bodies.
    bool uses_embree() const;
    const BodyQueryCounts& counts() const;

    /// Finds for every vertex the contact plane of the nearest surface within the radius, over all bodies. Vertices
    /// inside a closed form have a contact at any depth. The normal is the smooth one of BodySurface. Of several bodies
    /// the one with the smallest signed distance is taken. A vertex found far from all bodies is not searched again
    /// before it may have come within the radius.
    /// @param position  3 planes, component c of vertex v at [c * stride + v] [m]
    /// @param radius    search radius [m], > 0
    /// @param planes    written for vertices 0 to count - 1
    void nearest(const double* position, int stride, int count, double radius, const ContactPlanes& planes);

    bool moves() const;         ///< True if a body moves at some time.
    double motion_end() const;  ///< Time after which all bodies stand still [s]; 0 if none moves.
    double time() const;        ///< Time at which the bodies are placed [s].

    /// Moves all bodies to where they are at a time [s].
    void move_to(double time);

    /// Returns the longest of the steps room, room / 2, room / 4, ... from `time` on in which the surface of no body
    /// that may come into `near` meanwhile moves further than `way`, but no less than about 1e-6 room [s].
    /// @param time, room  [s]   @param way  [m], > 0
    double longest_step(double time, double room, double way, const Box& near) const;

    /// Returns where the last `move_to` took a point [m] that is attached to the surface which the last `nearest` found
    /// for a vertex. The point moves rigidly with the body, and if the body deforms also with the closest point of the
    /// closest triangle. Without a contact, or if the body stands still, the point stays.
    Vec3 carried(int vertex, const Vec3& point) const;

    /// Returns the mean velocity of that surface at a point during the last `move_to`, which covered
    /// `span` seconds [m/s].
    Vec3 surface_velocity(int vertex, const Vec3& point, double span) const
    {
        return (carried(vertex, point) - point) / span;
    }

    /// Forgets all lower bounds. This changes speed only, since the bounds also hold for positions that jumped.
    void forget();

    /// Finds for every vertex the first point at which its straight path from `from` to `to` enters a body. For a
    /// body that the last `move_to` moved, the path is taken relative to the body, and `from` holds the positions
    /// before that move.
    /// @param from, to  3 planes, as in nearest() [m]
    std::vector<BodyCrossing> crossings(const double* from, const double* to, int stride, int count);

    /// Returns the signed distance of every vertex to all triangles and closed forms, also outside the reach [m].
    std::vector<double> signed_distances(const double* position, int stride, int count) const;
    /// The same for a list of points. A reach that holds whole bodies spares building their hierarchies anew.
    std::vector<double> signed_distances(const std::vector<Vec3>& points) const;
    /// Sums up the signed distances of all vertices.
    BodyGap measure(const double* position, int stride, int count) const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace selvage
