#include "host/collision/body_query.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <utility>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>

namespace selvage {
namespace {

constexpr int vertices_per_task = 256;
constexpr double search_factor = 4;      // searching this many radii far lets a vertex be skipped for longer
constexpr double reach_growth = 0.25;    // of the reach's diagonal, when it must be widened

using VertexRange = tbb::blocked_range<int>;

vec3 kernel_vector(const Vec3& v) { return make_vec3(v.x(), v.y(), v.z()); }
Vec3 host_vector(vec3 v) { return {v.x, v.y, v.z}; }

Vec3 vertex_at(const double* position, int stride, int vertex) { return host_vector(load3(position, stride, vertex)); }

struct MeshBody {
    int body;                        // index among all bodies
    const BodySurface* surface;
    BodyBvh bvh;
};

struct AnalyticBody {
    int body;
    analytic_body shape;
};

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
    double lower_bound = 0;          // of the distance to any body [m]
};

struct GapSum {
    double min_gap = std::numeric_limits<double>::infinity();
    int inside = 0;
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
    std::vector<std::pair<int, BodySurface>> surfaces;   // with the body's index
    std::vector<AnalyticBody> analytic;
    std::optional<EmbreeDevice> device;
    Box reach;
    std::vector<MeshBody> meshes;
    BodyQueryCounts counts;

    // What is known about each vertex from its last search.
    std::vector<Vec3> last_position;
    std::vector<double> lower_bound;                     // of the distance to any body from last_position [m]
    std::vector<int> last_body, last_triangle;

    std::vector<MeshBody> build(const Box& box) const;
    void cover(const Box& needed);
    Nearest search(const Vec3& x, double radius, int hint_body, int hint_triangle) const;
    bool update(int vertex, const Vec3& x, double radius, const ContactPlanes& planes);
    BodyCrossing first_crossing(const Vec3& x0, const Vec3& x1) const;
};

std::vector<MeshBody> BodyQuery::Impl::build(const Box& box) const
{
    std::vector<MeshBody> built;
    for (const auto& [body, surface] : surfaces) built.push_back({body, &surface, BodyBvh(*device, surface, box)});
    return built;
}

void BodyQuery::Impl::cover(const Box& needed)
{
    if (counts.triangles_used == counts.triangles_total || needed.isEmpty() || reach.contains(needed)) return;
    const Box all = reach.merged(needed);
    reach = grown(all, reach_growth * all.diagonal().norm());
    meshes = build(reach);
    counts.triangles_used = 0;
    for (const MeshBody& mesh : meshes) counts.triangles_used += mesh.bvh.triangle_count();
    ++counts.rebuilds;
}

Nearest BodyQuery::Impl::search(const Vec3& x, double radius, int hint_body, int hint_triangle) const
{
    const double search_radius = search_factor * radius;
    Nearest best;
    best.lower_bound = search_radius;
    const auto closer = [&](int body, double signed_distance) {
        return signed_distance < best.signed_distance || (signed_distance == best.signed_distance && body < best.body);
    };
    for (const MeshBody& mesh : meshes) {
        const int hint = mesh.body == hint_body ? hint_triangle : -1;
        const NearestTriangle found = mesh.bvh.nearest(x, search_radius, hint);
        if (found.triangle < 0) continue;
        const double distance = std::sqrt(found.squared_distance);
        best.lower_bound = std::min(best.lower_bound, distance);
        if (distance > radius) continue;
        const SurfaceContact contact = mesh.surface->contact(x, found.triangle);
        if (!closer(mesh.body, contact.signed_distance)) continue;
        best.body = mesh.body;
        best.triangle = found.triangle;
        best.signed_distance = contact.signed_distance;
        best.gap = contact.gap;
        best.normal = contact.normal;
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

/// Answers for one vertex; returns whether that took a search.
bool BodyQuery::Impl::update(int vertex, const Vec3& x, double radius, const ContactPlanes& planes)
{
    if (lower_bound[vertex] - (x - last_position[vertex]).norm() > radius) {
        write_plane(planes, vertex, x, {});
        return false;
    }
    const Nearest nearest = search(x, radius, last_body[vertex], last_triangle[vertex]);
    write_plane(planes, vertex, x, nearest);
    last_position[vertex] = x;
    lower_bound[vertex] = nearest.lower_bound;
    last_body[vertex] = nearest.body;
    last_triangle[vertex] = nearest.triangle;
    return true;
}

BodyCrossing BodyQuery::Impl::first_crossing(const Vec3& x0, const Vec3& x1) const
{
    BodyCrossing first;
    const auto note = [&](int body, int triangle, double fraction) {
        if (fraction > 1 || fraction > first.fraction || (fraction == first.fraction && body > first.body)) return;
        first = {body, triangle, fraction};
    };
    for (const MeshBody& mesh : meshes) {
        const SurfaceEntry entry = mesh.bvh.first_entry(x0, x1);
        note(mesh.body, entry.triangle, entry.fraction);
    }
    for (const AnalyticBody& body : analytic)
        note(body.body, -1, std::max(0.0, analytic_crossing(kernel_vector(x0), kernel_vector(x1), &body.shape)));
    return first;
}

BodyQuery::BodyQuery(const std::vector<Body>& bodies, const Box& reach) : impl_(std::make_unique<Impl>())
{
    impl_->reach = reach;
    for (int index = 0; index < int(bodies.size()); ++index) {
        const Body& body = bodies[index];
        if (body.kind == Body::Kind::mesh) {
            impl_->surfaces.emplace_back(index, BodySurface(body.mesh));
            impl_->counts.triangles_total += int(body.mesh.faces.size());
        } else {
            impl_->analytic.push_back({index, closed_form(body)});
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

void BodyQuery::forget()
{
    impl_->last_position.clear();
    impl_->lower_bound.clear();
    impl_->last_body.clear();
    impl_->last_triangle.clear();
}

void BodyQuery::nearest(const double* position, int stride, int count, double radius, const ContactPlanes& planes)
{
    if (int(impl_->last_position.size()) != count) {
        forget();
        impl_->last_position.resize(count, Vec3::Zero());
        impl_->lower_bound.resize(count, 0);
        impl_->last_body.resize(count, -1);
        impl_->last_triangle.resize(count, -1);
    }
    impl_->cover(grown(bounding_box(position, stride, count), search_factor * radius));
    const long long made = tbb::parallel_reduce(
        VertexRange(0, count, vertices_per_task), 0LL,
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
    impl_->cover(bounding_box(from, stride, count).merged(bounding_box(to, stride, count)));
    std::vector<BodyCrossing> found(count);
    tbb::parallel_for(VertexRange(0, count, vertices_per_task), [&](const VertexRange& range) {
        for (int v = range.begin(); v < range.end(); ++v)
            found[v] = impl_->first_crossing(vertex_at(from, stride, v), vertex_at(to, stride, v));
    });
    return found;
}

BodyGap BodyQuery::measure(const double* position, int stride, int count) const
{
    const bool is_complete = impl_->counts.triangles_used == impl_->counts.triangles_total;
    constexpr double far = std::numeric_limits<double>::max();
    const std::vector<MeshBody> whole =
        is_complete ? std::vector<MeshBody>() : impl_->build(Box(Vec3::Constant(-far), Vec3::Constant(far)));
    const std::vector<MeshBody>& meshes = is_complete ? impl_->meshes : whole;

    const auto signed_distance = [&](const Vec3& x, std::vector<int>& hints) {
        double smallest = std::numeric_limits<double>::infinity();
        for (std::size_t m = 0; m < meshes.size(); ++m) {
            hints[m] = meshes[m].bvh.nearest(x, meshes[m].bvh.far_radius(x), hints[m]).triangle;
            if (hints[m] >= 0) smallest = std::min(smallest, meshes[m].surface->contact(x, hints[m]).signed_distance);
        }
        for (const AnalyticBody& body : impl_->analytic)
            smallest = std::min(smallest, analytic_contact(kernel_vector(x), &body.shape).gap);
        return smallest;
    };
    const GapSum sum = tbb::parallel_reduce(
        VertexRange(0, count, vertices_per_task), GapSum(),
        [&](const VertexRange& range, GapSum part) {
            std::vector<int> hints(meshes.size(), -1);   // the previous vertex's triangle bounds the search
            for (int v = range.begin(); v < range.end(); ++v) {
                const double distance = signed_distance(vertex_at(position, stride, v), hints);
                part.min_gap = std::min(part.min_gap, distance);
                part.inside += distance < 0;
            }
            return part;
        },
        [](const GapSum& a, const GapSum& b) { return GapSum{std::min(a.min_gap, b.min_gap), a.inside + b.inside}; });
    return {std::max(0.0, -sum.min_gap), sum.min_gap, sum.inside};
}

}  // namespace selvage
