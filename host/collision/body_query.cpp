#include "host/collision/body_query.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <utility>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>

#include "host/model/body.hpp"

namespace selvage {
namespace {

// Chosen by hand; not measured. All but motion_parts affect speed only.
struct BodyQueryTuning {
    static constexpr int vertices_per_task = 256;
    // Range of a search over the contact radius [1]. A longer range gives vertices far from all bodies a larger lower
    // bound of their distance, so that they are skipped for longer.
    static constexpr double search_factor = 4;
    static constexpr double reach_growth = 0.25;  // of a reach that is too small, over its diagonal [1]
    // Parts of a step whose bounds of the displacement are summed, so that a body that turns far and comes back within
    // the step is not taken for one at rest.
    static constexpr int motion_parts = 4;
};

using VertexRange = tbb::blocked_range<int>;

vec3 kernel_vector(const Vec3& v) { return make_vec3(v.x(), v.y(), v.z()); }
Vec3 host_vector(vec3 v) { return {v.x, v.y, v.z}; }

Vec3 vertex_at(const double* position, int stride, int vertex) { return host_vector(load3(position, stride, vertex)); }

struct MeshBody {
    int body;  // index among all bodies
    const BodySurface* surface;
    BodyBvh bvh;
    int mover;  // index among those that move, or -1
};

struct AnalyticBody {
    int body;
    analytic_body shape, at_start;
};

/// A body that moves: where it is and where it was before the last move.
struct Mover {
    int body;
    std::shared_ptr<const BodyMotion> motion;
    Box box;     // around the body at time 0
    bool plane;  // an infinite plane, which a rotation displaces without bound
    Placement now, before;
    std::vector<Vec3> vertices_before;  // before the last move, of a body that deforms
    bool moved;                         // in the last move
};

analytic_body placed(analytic_body shape, const Placement& place)
{
    shape.center = kernel_vector(place * host_vector(shape.center));
    shape.end = kernel_vector(place * host_vector(shape.end));
    shape.normal = kernel_vector(place.linear() * host_vector(shape.normal));
    return shape;
}

analytic_body closed_form(const Body& body)
{
    const analytic_shape shape = body.kind == Body::Kind::plane    ? PLANE_SHAPE
                                 : body.kind == Body::Kind::sphere ? SPHERE_SHAPE
                                                                   : CAPSULE_SHAPE;
    return {shape, kernel_vector(body.center), kernel_vector(body.end), kernel_vector(body.normal), body.radius};
}

/// The outcome of one search over all bodies.
struct Nearest {
    int body = -1, triangle = -1;
    double signed_distance = std::numeric_limits<double>::infinity();
    double gap = 0;
    Vec3 normal = Vec3::Zero();
    double lower_bound = 0;  // of the distance to any body [m]
};

/// The box around all vertices that are finite; a run that diverges is noticed elsewhere.
Box bounding_box(const double* position, int stride, int count)
{
    return tbb::parallel_reduce(
        VertexRange(0, count, 4096), Box(),
        [&](const VertexRange& range, Box box) {
            for (int v = range.begin(); v < range.end(); ++v) {
                const Vec3 x = vertex_at(position, stride, v);
                if (x.allFinite()) box.extend(x);
            }
            return box;
        },
        [](const Box& a, const Box& b) { return a.merged(b); });
}

Box grown(const Box& box, double margin)
{
    return box.isEmpty() ? box : Box(box.min().array() - margin, box.max().array() + margin);
}

void write_plane(const ContactPlanes& planes, int vertex, const Vec3& x, const Nearest& nearest)
{
    store3(planes.normal, planes.stride, vertex, kernel_vector(nearest.normal));
    planes.offset[vertex] = nearest.body < 0 ? no_contact_offset : nearest.normal.dot(x) - nearest.gap;
    planes.body[vertex] = nearest.body;
}

}  // namespace

struct BodyQuery::Impl {
    std::vector<std::pair<int, BodySurface>> surfaces;  // with the body's index
    std::vector<AnalyticBody> analytic;
    std::optional<EmbreeDevice> device;
    Box reach;
    std::vector<MeshBody> meshes;
    BodyQueryCounts counts;
    std::vector<Mover> movers;
    std::vector<int> mover_of;  // per body; -1: it stands still
    double time = 0;
    double travel = 0;  // upper bound of the path length of any surface point so far [m]

    // What is known about each vertex from its last search.
    std::vector<Vec3> last_position;
    std::vector<double> lower_bound;  // of the distance to any body from last_position [m]
    std::vector<int> last_body, last_triangle;
    std::vector<double> last_travel;  // only if there are movers [m]
    std::vector<Vec3> last_weights;   // of the closest point in its triangle; only if there are movers

    Vec3 to_body(const MeshBody& mesh, const Vec3& x) const
    {
        return mesh.mover < 0 ? x : Vec3(movers[mesh.mover].now.inverse() * x);
    }
    Vec3 to_scene(const MeshBody& mesh, const Vec3& direction) const
    {
        return mesh.mover < 0 ? direction : Vec3(movers[mesh.mover].now.linear() * direction);
    }
    std::vector<MeshBody> build(const Box& box) const;
    void extend_reach(const Box& needed);
    Nearest search(const Vec3& x, double radius, int hint_body, int hint_triangle) const;
    bool update(int vertex, const Vec3& x, double radius, const ContactPlanes& planes);
    void store_surface(int vertex, const Vec3& x);
    void add_mover(int index, const Body& body);
    void move(Mover& mover, double to);
    Vec3 carried(const Mover& mover, int vertex, const Vec3& point) const;
    Vec3 start_relative_to(int body, int vertex, const Vec3& x0) const;
    BodyCrossing first_crossing(int vertex, const Vec3& x0, const Vec3& x1) const;
};

std::vector<MeshBody> BodyQuery::Impl::build(const Box& box) const
{
    std::vector<MeshBody> built;
    constexpr double far = std::numeric_limits<double>::max();
    const Box everywhere(Vec3::Constant(-far), Vec3::Constant(far));
    for (const auto& [body, surface] : surfaces) {
        const int mover = mover_of[body];  // any part of a moving body may come within reach
        const bool deforms = mover >= 0 && movers[mover].motion->deforms();
        built.push_back({body, &surface, BodyBvh(*device, surface, mover < 0 ? box : everywhere, deforms), mover});
    }
    return built;
}

void BodyQuery::Impl::extend_reach(const Box& needed)
{
    if (counts.triangles_used == counts.triangles_total || needed.isEmpty() || reach.contains(needed)) return;
    const Box all = reach.merged(needed);
    reach = grown(all, BodyQueryTuning::reach_growth * all.diagonal().norm());
    meshes = build(reach);
    counts.triangles_used = 0;
    for (const MeshBody& mesh : meshes) counts.triangles_used += mesh.bvh.triangle_count();
    ++counts.rebuilds;
}

Nearest BodyQuery::Impl::search(const Vec3& x, double radius, int hint_body, int hint_triangle) const
{
    const double search_radius = BodyQueryTuning::search_factor * radius;
    Nearest best;
    best.lower_bound = search_radius;
    const auto closer = [&](int body, double signed_distance) {
        return signed_distance < best.signed_distance || (signed_distance == best.signed_distance && body < best.body);
    };
    for (const MeshBody& mesh : meshes) {
        const int hint = mesh.body == hint_body ? hint_triangle : -1;
        const Vec3 local = to_body(mesh, x);
        const NearestTriangle found = mesh.bvh.nearest(local, search_radius, hint);
        if (found.triangle < 0) continue;
        const double distance = std::sqrt(found.squared_distance);
        best.lower_bound = std::min(best.lower_bound, distance);
        if (distance > radius) continue;
        const SurfaceContact contact = mesh.surface->contact(local, found.triangle);
        if (!closer(mesh.body, contact.signed_distance)) continue;
        best.body = mesh.body;
        best.triangle = found.triangle;
        best.signed_distance = contact.signed_distance;
        best.gap = contact.gap;
        best.normal = to_scene(mesh, contact.normal);
    }
    for (const AnalyticBody& body : analytic) {
        const body_contact contact = analytic_contact(kernel_vector(x), &body.shape);
        best.lower_bound = std::min(best.lower_bound, std::max(contact.gap, 0.0));
        if (contact.gap > radius || !closer(body.body, contact.gap)) continue;
        best.body = body.body;
        best.triangle = -1;
        best.signed_distance = best.gap = contact.gap;
        best.normal = host_vector(contact.normal);
    }
    return best;
}

/// Stores what `carried` needs to move a point with the surface that was found for a vertex.
void BodyQuery::Impl::store_surface(int vertex, const Vec3& x)
{
    last_travel[vertex] = travel;
    const int body = last_body[vertex], triangle = last_triangle[vertex];
    if (triangle < 0 || mover_of[body] < 0 || !movers[mover_of[body]].motion->deforms()) return;
    const auto surface = std::find_if(surfaces.begin(), surfaces.end(), [&](const auto& s) { return s.first == body; });
    last_weights[vertex] = surface->second.closest(movers[mover_of[body]].now.inverse() * x, triangle).weights;
}

void BodyQuery::Impl::add_mover(int index, const Body& body)
{
    mover_of.push_back(-1);
    if (!body.motion) return;
    mover_of.back() = int(movers.size());
    const Box box = box_of(body.mesh.vertices);
    // The box is enlarged, since the tessellation of a sphere or capsule lies inside the exact surface.
    movers.push_back({index,
                      body.motion,
                      grown(box, 0.01 * box.diagonal().norm()),
                      body.kind == Body::Kind::plane,
                      Placement::Identity(),
                      Placement::Identity(),
                      {},
                      false});
}

void BodyQuery::Impl::move(Mover& mover, double to)
{
    const double end = mover.motion->end();
    mover.moved = std::min(time, end) != std::min(to, end);
    if (!mover.moved) return;
    const Placement place = mover.motion->placement(to);
    const bool turns = !place.linear().isApprox(mover.now.linear(), 1e-15);
    travel +=
        mover.plane && turns ? std::numeric_limits<double>::infinity() : mover.motion->distance(time, to, mover.box);
    mover.before = mover.now;
    mover.now = place;
    for (AnalyticBody& body : analytic)
        if (body.body == mover.body) body.shape = placed(body.at_start, mover.now);
    if (!mover.motion->deforms()) return;
    for (std::size_t k = 0; k < surfaces.size(); ++k) {
        if (surfaces[k].first != mover.body) continue;
        mover.vertices_before = surfaces[k].second.vertices();
        std::vector<Vec3> vertices;
        mover.motion->vertices_at(to, vertices);
        surfaces[k].second.deform(vertices);
        meshes[k].bvh.refit();
    }
}

/// Writes the contact plane of one vertex; returns whether a search was necessary.
bool BodyQuery::Impl::update(int vertex, const Vec3& x, double radius, const ContactPlanes& planes)
{
    const double surfaces_moved = movers.empty() ? 0 : travel - last_travel[vertex];
    if (lower_bound[vertex] - (x - last_position[vertex]).norm() - surfaces_moved > radius) {
        write_plane(planes, vertex, x, {});
        if (!movers.empty()) last_body[vertex] = -1;
        return false;
    }
    const Nearest nearest = search(x, radius, last_body[vertex], last_triangle[vertex]);
    write_plane(planes, vertex, x, nearest);
    last_position[vertex] = x;
    lower_bound[vertex] = nearest.lower_bound;
    last_body[vertex] = nearest.body;
    last_triangle[vertex] = nearest.triangle;
    if (!movers.empty()) store_surface(vertex, x);
    return true;
}

// Returns where the last move took a point that is attached to a body, or to the triangle last found for the vertex if
// the body deforms.
Vec3 BodyQuery::Impl::carried(const Mover& mover, int vertex, const Vec3& point) const
{
    Vec3 local = mover.before.inverse() * point;
    if (mover.motion->deforms() && vertex < int(last_body.size()) && last_body[vertex] == mover.body)
        for (const auto& [index, surface] : surfaces)
            for (int k = 0; index == mover.body && k < 3; ++k) {
                const int corner = surface.face(last_triangle[vertex])[k];
                local += last_weights[vertex][k] * (surface.vertices()[corner] - mover.vertices_before[corner]);
            }
    return mover.now * local;
}

Vec3 BodyQuery::Impl::start_relative_to(int body, int vertex, const Vec3& x0) const
{
    const int at = mover_of[body];
    return at >= 0 && movers[at].moved ? carried(movers[at], vertex, x0) : x0;
}

BodyCrossing BodyQuery::Impl::first_crossing(int vertex, const Vec3& x0, const Vec3& x1) const
{
    BodyCrossing first;
    const auto note = [&](int body, int triangle, double fraction, const Vec3& from) {
        if (fraction > 1 || fraction > first.fraction || (fraction == first.fraction && body > first.body)) return;
        first = {body, triangle, fraction, (1 - fraction) * (x1 - from).norm()};
    };
    for (const MeshBody& mesh : meshes) {
        const Vec3 from = start_relative_to(mesh.body, vertex, x0);
        const SurfaceEntry entry = mesh.bvh.first_entry(to_body(mesh, from), to_body(mesh, x1));
        note(mesh.body, entry.triangle, entry.fraction, from);
    }
    for (const AnalyticBody& body : analytic) {
        const Vec3 from = start_relative_to(body.body, vertex, x0);
        const double fraction = analytic_crossing(kernel_vector(from), kernel_vector(x1), &body.shape);
        note(body.body, -1, std::max(0.0, fraction), from);
    }
    return first;
}

BodyQuery::BodyQuery(const std::vector<Body>& bodies, const Box& reach) : impl_(std::make_unique<Impl>())
{
    impl_->reach = reach;
    for (int index = 0; index < int(bodies.size()); ++index) {
        const Body& body = bodies[index];
        impl_->add_mover(index, body);
        if (body.kind == Body::Kind::mesh) {
            impl_->surfaces.emplace_back(index, BodySurface(body.mesh));
            impl_->counts.triangles_total += int(body.mesh.faces.size());
        } else {
            impl_->analytic.push_back({index, closed_form(body), closed_form(body)});
        }
    }
    if (impl_->surfaces.empty()) return;
    impl_->device.emplace();
    impl_->meshes = impl_->build(reach);
    for (const MeshBody& mesh : impl_->meshes) impl_->counts.triangles_used += mesh.bvh.triangle_count();
}

BodyQuery::~BodyQuery() = default;
BodyQuery::BodyQuery(BodyQuery&&) noexcept = default;
BodyQuery& BodyQuery::operator=(BodyQuery&&) noexcept = default;

bool BodyQuery::empty() const { return impl_->surfaces.empty() && impl_->analytic.empty(); }
bool BodyQuery::uses_embree() const { return impl_->device.has_value(); }
const BodyQueryCounts& BodyQuery::counts() const { return impl_->counts; }
bool BodyQuery::moves() const { return !impl_->movers.empty(); }
double BodyQuery::time() const { return impl_->time; }

double BodyQuery::motion_end() const
{
    double end = 0;
    for (const Mover& mover : impl_->movers) end = std::max(end, mover.motion->end());
    return end;
}

void BodyQuery::move_to(double time)
{
    for (Mover& mover : impl_->movers) impl_->move(mover, time);
    impl_->time = time;
}

double BodyQuery::longest_step(double time, double room, double way, const Box& near) const
{
    const auto too_far = [&](double dt) {
        return std::any_of(impl_->movers.begin(), impl_->movers.end(), [&](const Mover& mover) {
            double sum = 0;
            for (int k = 0; k < BodyQueryTuning::motion_parts; ++k)
                sum += mover.motion->distance(time + k * dt / BodyQueryTuning::motion_parts,
                                              time + (k + 1) * dt / BodyQueryTuning::motion_parts, mover.box);
            if (sum <= way) return false;
            const Box at = mover.motion->box_at(time, mover.box);
            return mover.plane || near.exteriorDistance(at) <= sum;
        });
    };
    double dt = room;
    while (too_far(dt) && dt > 1e-6 * room) dt *= 0.5;
    return dt;
}

Vec3 BodyQuery::carried(int vertex, const Vec3& point) const
{
    const int body = impl_->last_body[vertex], at = body < 0 ? -1 : impl_->mover_of[body];
    if (at < 0) return point;
    return impl_->movers[at].moved ? impl_->carried(impl_->movers[at], vertex, point) : point;
}

void BodyQuery::forget()
{
    impl_->last_position.clear();
    impl_->lower_bound.clear();
    impl_->last_body.clear();
    impl_->last_triangle.clear();
    impl_->last_travel.clear();
    impl_->last_weights.clear();
}

void BodyQuery::nearest(const double* position, int stride, int count, double radius, const ContactPlanes& planes)
{
    if (int(impl_->last_position.size()) != count) {
        forget();
        impl_->last_position.resize(count, Vec3::Zero());
        impl_->lower_bound.resize(count, 0);
        impl_->last_body.resize(count, -1);
        impl_->last_triangle.resize(count, -1);
        if (moves()) {
            impl_->last_travel.resize(count, 0);
            impl_->last_weights.resize(count, Vec3::Zero());
        }
    }
    impl_->extend_reach(grown(bounding_box(position, stride, count), BodyQueryTuning::search_factor * radius));
    const long long made = tbb::parallel_reduce(
        VertexRange(0, count, BodyQueryTuning::vertices_per_task), 0LL,
        [&](const VertexRange& range, long long sum) {
            for (int v = range.begin(); v < range.end(); ++v)
                sum += impl_->update(v, vertex_at(position, stride, v), radius, planes);
            return sum;
        },
        std::plus<>{});
    impl_->counts.made += made;
    impl_->counts.skipped += count - made;
}

std::vector<BodyCrossing> BodyQuery::crossings(const double* from, const double* to, int stride, int count)
{
    impl_->extend_reach(bounding_box(from, stride, count).merged(bounding_box(to, stride, count)));
    std::vector<BodyCrossing> found(count);
    tbb::parallel_for(VertexRange(0, count, BodyQueryTuning::vertices_per_task), [&](const VertexRange& range) {
        for (int v = range.begin(); v < range.end(); ++v)
            found[v] = impl_->first_crossing(v, vertex_at(from, stride, v), vertex_at(to, stride, v));
    });
    return found;
}

std::vector<double> BodyQuery::signed_distances(const double* position, int stride, int count) const
{
    const bool is_complete = impl_->counts.triangles_used == impl_->counts.triangles_total;
    constexpr double far = std::numeric_limits<double>::max();
    const std::vector<MeshBody> whole =
        is_complete ? std::vector<MeshBody>() : impl_->build(Box(Vec3::Constant(-far), Vec3::Constant(far)));
    const std::vector<MeshBody>& meshes = is_complete ? impl_->meshes : whole;

    const auto signed_distance = [&](const Vec3& x, std::vector<int>& hints) {
        double smallest = std::numeric_limits<double>::infinity();
        for (std::size_t m = 0; m < meshes.size(); ++m) {
            const MeshBody& mesh = meshes[m];
            const Vec3 local = impl_->to_body(mesh, x);
            hints[m] = mesh.bvh.nearest(local, mesh.bvh.far_radius(local), hints[m]).triangle;
            if (hints[m] >= 0) smallest = std::min(smallest, mesh.surface->contact(local, hints[m]).signed_distance);
        }
        for (const AnalyticBody& body : impl_->analytic)
            smallest = std::min(smallest, analytic_contact(kernel_vector(x), &body.shape).gap);
        return smallest;
    };
    std::vector<double> distances(count);
    tbb::parallel_for(VertexRange(0, count, BodyQueryTuning::vertices_per_task), [&](const VertexRange& range) {
        std::vector<int> hints(meshes.size(), -1);  // the triangle closest to the previous vertex bounds the search
        for (int v = range.begin(); v < range.end(); ++v)
            distances[v] = signed_distance(vertex_at(position, stride, v), hints);
    });
    return distances;
}

std::vector<double> BodyQuery::signed_distances(const std::vector<Vec3>& points) const
{
    const std::size_t count = points.size();
    std::vector<double> planes(3 * count);
    for (std::size_t k = 0; k < count; ++k)
        for (int c = 0; c < 3; ++c) planes[std::size_t(c) * count + k] = points[k][c];
    return signed_distances(planes.data(), int(count), int(count));
}

BodyGap BodyQuery::measure(const double* position, int stride, int count) const
{
    BodyGap gap{0, std::numeric_limits<double>::infinity(), 0};
    for (const double distance : signed_distances(position, stride, count)) {
        gap.min_gap_m = std::min(gap.min_gap_m, distance);
        gap.vertices_inside += distance < 0;
    }
    gap.max_penetration_m = std::max(0.0, -gap.min_gap_m);
    return gap;
}

}  // namespace selvage
