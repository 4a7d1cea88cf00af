#include "host/collision/body_bvh.hpp"

#include <algorithm>
#include <cmath>
#include <new>
#include <stdexcept>
#include <vector>

#include "host/embree/rays.hpp"
#include "host/parallel/trace.hpp"

namespace selvage {
namespace {

constexpr double rounding = 1e-6;    // relative, of lengths in single precision (6e-8), with a wide margin [1]
constexpr double on_surface = 1e-9;  // [m]; a path may start this far inside and still enter

struct Corners {
    Vec3 a, b, c;
};

struct NearestSearch {
    const Corners* corners;
    const int* triangles;
    Vec3 x;
    double slack;  // [m]; keeps the single-precision search from missing the closest triangle
    NearestTriangle best;

    bool improve(int triangle, double squared_distance)
    {
        const bool closer =
            squared_distance < best.squared_distance ||
            (squared_distance == best.squared_distance && (best.triangle < 0 || triangle < best.triangle));
        if (closer) best = {triangle, squared_distance};
        return closer;
    }
    float radius() const { return float(std::sqrt(best.squared_distance) * (1 + rounding) + slack); }
};

bool visit_triangle(RTCPointQueryFunctionArguments* args)
{
    NearestSearch& search = *static_cast<NearestSearch*>(args->userPtr);
    const Corners& t = search.corners[args->primID];
    const double squared_distance = closest_on_triangle(search.x, t.a, t.b, t.c).squared_distance;
    if (!search.improve(search.triangles[args->primID], squared_distance)) return false;
    args->query->radius = search.radius();
    return true;
}

struct EntrySearch {
    RayContext context;  // first, so that the library's pointer to it is one to this struct
    const BodySurface* surface;
    const int* triangles;
    Vec3 x0, x1;
    SurfaceEntry first;
};

/// Embree's filter of hits: stores the hit if the path enters the body there, and rejects it, so that the ray also
/// visits all other triangles.
void note_entry(const RTCFilterFunctionNArguments* args)
{
    args->valid[0] = 0;
    EntrySearch& search = *reinterpret_cast<EntrySearch*>(args->context);
    const int triangle = search.triangles[RTCHitN_primID(args->hit, args->N, 0)];
    const Vec3& normal = search.surface->face_normal(triangle);
    const Vec3& corner = search.surface->corner(triangle, 0);
    const double start = normal.dot(search.x0 - corner), end = normal.dot(search.x1 - corner);
    if (!(end < start) || start < -on_surface || end > 0) return;
    const double fraction = std::clamp(start / (start - end), 0.0, 1.0);
    SurfaceEntry& first = search.first;
    if (fraction < first.fraction || (fraction == first.fraction && triangle < first.triangle))
        first = {triangle, fraction};
}

bool touches(const BodySurface& surface, int triangle, const Box& reach)
{
    Box box;
    for (int k = 0; k < 3; ++k) box.extend(surface.corner(triangle, k));
    return reach.intersects(box);
}

}  // namespace

EmbreeDevice::EmbreeDevice()
{
    const TraceScope scope("embree");
    handle_ = rtcNewDevice(nullptr);
    if (!handle_) throw std::runtime_error("Embree does not start on this machine");
}

EmbreeDevice::~EmbreeDevice() { rtcReleaseDevice(static_cast<RTCDevice>(handle_)); }

struct BodyBvh::Impl {
    const BodySurface* surface;
    std::vector<int> triangles;  // of the surface, by index in the hierarchy
    std::vector<Corners> corners;
    Vec3 origin = Vec3::Zero();  // single-precision coordinates are relative to it
    double extent = 0;           // largest distance of a triangle from the origin [m]
    RTCDevice device = nullptr;
    RTCScene scene = nullptr;
    float* vertex = nullptr;  // owned by the hierarchy, nine numbers per triangle

    ~Impl() { rtcReleaseScene(scene); }
    void read_corners();
    void write_vertices();
    void commit();
    double slack(const Vec3& x) const { return rounding * (extent + (x - origin).norm()); }
};

void BodyBvh::Impl::read_corners()
{
    Box box;
    for (std::size_t k = 0; k < triangles.size(); ++k) {
        const int t = triangles[k];
        corners[k] = {surface->corner(t, 0), surface->corner(t, 1), surface->corner(t, 2)};
        for (const Vec3* corner : {&corners[k].a, &corners[k].b, &corners[k].c}) box.extend(*corner);
    }
    origin = box.isEmpty() ? Vec3(Vec3::Zero()) : Vec3(box.center());
    extent = box.isEmpty() ? 0 : box.diagonal().norm() / 2;
}

void BodyBvh::Impl::write_vertices()
{
    float* to = vertex;
    for (const Corners& t : corners)
        for (const Vec3* corner : {&t.a, &t.b, &t.c})
            for (int c = 0; c < 3; ++c) *to++ = float((*corner)[c] - origin[c]);
}

void BodyBvh::Impl::commit()
{
    rtcCommitScene(scene);
    if (rtcGetDeviceError(device) != RTC_ERROR_NONE)
        throw std::runtime_error("Embree failed to build a body's hierarchy");
}

BodyBvh::BodyBvh(const EmbreeDevice& device, const BodySurface& surface, const Box& reach, bool deforms)
    : impl_(std::make_unique<Impl>())
{
    impl_->surface = &surface;
    for (int t = 0; t < surface.triangle_count(); ++t)
        if (surface.has_area(t) && touches(surface, t, reach)) impl_->triangles.push_back(t);
    const int count = triangle_count();
    impl_->corners.resize(std::size_t(count));
    impl_->read_corners();
    const RTCDevice rtc = impl_->device = static_cast<RTCDevice>(device.handle());
    impl_->scene = rtcNewScene(rtc);
    // Embree refits only the two-level hierarchies of dynamic scenes.
    rtcSetSceneFlags(impl_->scene,
                     deforms ? RTCSceneFlags(RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_DYNAMIC) : RTC_SCENE_FLAG_ROBUST);
    rtcSetSceneBuildQuality(impl_->scene, deforms ? RTC_BUILD_QUALITY_LOW : RTC_BUILD_QUALITY_HIGH);
    if (count > 0) {
        const RTCGeometry geometry = rtcNewGeometry(rtc, RTC_GEOMETRY_TYPE_TRIANGLE);
        if (deforms) rtcSetGeometryBuildQuality(geometry, RTC_BUILD_QUALITY_REFIT);
        impl_->vertex = static_cast<float*>(rtcSetNewGeometryBuffer(
            geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), std::size_t(3) * count));
        unsigned* index = static_cast<unsigned*>(rtcSetNewGeometryBuffer(
            geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(unsigned), std::size_t(count)));
        if (!impl_->vertex || !index) throw std::bad_alloc();
        impl_->write_vertices();
        for (int k = 0; k < 3 * count; ++k) index[k] = unsigned(k);
        rtcSetGeometryIntersectFilterFunction(geometry, note_entry);
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(impl_->scene, geometry);
        rtcReleaseGeometry(geometry);
    }
    impl_->commit();
}

void BodyBvh::refit()
{
    if (triangle_count() == 0) return;
    impl_->read_corners();
    impl_->write_vertices();
    const RTCGeometry geometry = rtcGetGeometry(impl_->scene, 0);
    rtcUpdateGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0);
    rtcCommitGeometry(geometry);
    impl_->commit();
}

BodyBvh::~BodyBvh() = default;
BodyBvh::BodyBvh(BodyBvh&&) noexcept = default;
BodyBvh& BodyBvh::operator=(BodyBvh&&) noexcept = default;

int BodyBvh::triangle_count() const { return int(impl_->triangles.size()); }

double BodyBvh::far_radius(const Vec3& x) const { return 1.01 * ((x - impl_->origin).norm() + impl_->extent); }

NearestTriangle BodyBvh::nearest(const Vec3& x, double radius, int hint) const
{
    NearestSearch search{impl_->corners.data(), impl_->triangles.data(), x, impl_->slack(x), {-1, radius * radius}};
    if (hint >= 0) search.improve(hint, impl_->surface->closest(x, hint).squared_distance);

    const Vec3 local = x - impl_->origin;
    RTCPointQuery query;
    query.x = float(local.x());
    query.y = float(local.y());
    query.z = float(local.z());
    query.time = 0;
    query.radius = search.radius();
    RTCPointQueryContext context;
    rtcInitPointQueryContext(&context);
    rtcPointQuery(impl_->scene, &query, &context, visit_triangle, &search);
    return search.best;
}

SurfaceEntry BodyBvh::first_entry(const Vec3& x0, const Vec3& x1) const
{
    EntrySearch search{make_ray_context(), impl_->surface, impl_->triangles.data(), x0, x1, {}};
    const double length = (x1 - x0).norm();
    if (!(length > 0)) return search.first;
    // The ray is longer than the path by the rounding error at both ends. Whether a triangle near an end counts is
    // decided in double precision.
    const double slack = impl_->slack(x0);
    const Vec3 direction = (x1 - x0) / length, origin = x0 - slack * direction - impl_->origin;

    RTCRayHit ray{};
    ray.ray.org_x = float(origin.x());
    ray.ray.org_y = float(origin.y());
    ray.ray.org_z = float(origin.z());
    ray.ray.dir_x = float(direction.x());
    ray.ray.dir_y = float(direction.y());
    ray.ray.dir_z = float(direction.z());
    ray.ray.tnear = 0;
    ray.ray.tfar = float(length + 2 * slack);
    ray.ray.mask = ~0u;
    ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    ray.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    find_first_hit(impl_->scene, ray, search.context, RayOrder::unrelated);
    return search.first;
}

}  // namespace selvage
