#include "host/collision/self_intersections.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <stdexcept>
#include <utility>

#include <embree3/rtcore.h>
#include <tbb/concurrent_vector.h>
#include <tbb/parallel_for.h>

#include "host/collision/body_bvh.hpp"
#include "host/collision/triangle_intersection.hpp"

namespace selvage {
namespace {

// The triangles of a mesh in a hierarchy of boxes.
class TriangleBoxes {
public:
    TriangleBoxes(const EmbreeDevice& device, const std::vector<Vec3>& vertices, const std::vector<Face>& faces)
        : vertices_(vertices), faces_(faces), has_area_(faces.size())
    {
        tbb::parallel_for(std::size_t(0), faces.size(),
                          [&](std::size_t f) { has_area_[f] = !is_degenerate(triangle(int(f))); });
        const RTCDevice rtc = static_cast<RTCDevice>(device.handle());
        scene_ = rtcNewScene(rtc);
        const RTCGeometry geometry = rtcNewGeometry(rtc, RTC_GEOMETRY_TYPE_USER);
        rtcSetGeometryUserPrimitiveCount(geometry, unsigned(faces.size()));
        rtcSetGeometryUserData(geometry, this);
        rtcSetGeometryBoundsFunction(geometry, write_bounds, nullptr);
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(scene_, geometry);
        rtcReleaseGeometry(geometry);
        rtcCommitScene(scene_);
        if (rtcGetDeviceError(rtc) != RTC_ERROR_NONE) throw std::runtime_error("Embree failed to build a hierarchy of triangles");
    }
    ~TriangleBoxes() { rtcReleaseScene(scene_); }
    TriangleBoxes(const TriangleBoxes&) = delete;
    TriangleBoxes& operator=(const TriangleBoxes&) = delete;

    RTCScene scene() const { return scene_; }
    const Face& face(int f) const { return faces_[f]; }
    const Vec3& vertex(int v) const { return vertices_[v]; }
    bool has_area(int f) const { return has_area_[f]; }
    Triangle triangle(int f) const
    {
        return {vertices_[faces_[f][0]], vertices_[faces_[f][1]], vertices_[faces_[f][2]]};
    }

private:
    // Single precision, rounded outwards.
    static void write_bounds(const RTCBoundsFunctionArguments* args)
    {
        const Triangle t = static_cast<const TriangleBoxes*>(args->geometryUserPtr)->triangle(int(args->primID));
        const Vec3 low = t[0].cwiseMin(t[1]).cwiseMin(t[2]), high = t[0].cwiseMax(t[1]).cwiseMax(t[2]);
        constexpr float far = std::numeric_limits<float>::infinity();
        const auto below = [](double x) { return std::nextafter(float(x), -far); };
        const auto above = [](double x) { return std::nextafter(float(x), far); };
        *args->bounds_o = {below(low.x()), below(low.y()), below(low.z()), 0,
                           above(high.x()), above(high.y()), above(high.z()), 0};
    }

    const std::vector<Vec3>& vertices_;
    const std::vector<Face>& faces_;
    std::vector<char> has_area_;
    RTCScene scene_ = nullptr;
};

struct Collected {
    std::function<bool(int, int)> meet;
    bool symmetric;    // both meshes are one: pairs may come either way round, and twice
    tbb::concurrent_vector<IntersectingPair> pairs;
};

void collect(void* to, RTCCollision* collisions, unsigned count)
{
    Collected& collected = *static_cast<Collected*>(to);
    for (unsigned k = 0; k < count; ++k) {
        int a = int(collisions[k].primID0), b = int(collisions[k].primID1);
        if (collected.symmetric && a > b) std::swap(a, b);
        if (collected.meet(a, b)) collected.pairs.push_back({a, b});
    }
}

std::vector<IntersectingPair> collide(RTCScene a, RTCScene b, std::function<bool(int, int)> meet)
{
    Collected collected{std::move(meet), a == b, {}};
    rtcCollide(a, b, collect, &collected);
    std::vector<IntersectingPair> pairs(collected.pairs.begin(), collected.pairs.end());
    std::sort(pairs.begin(), pairs.end());
    pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
    return pairs;
}

int shared_corners(const Face& f, const Face& g)
{
    return int(std::count_if(f.begin(), f.end(), [&](int v) { return std::find(g.begin(), g.end(), v) != g.end(); }));
}

// True if the edge of f that lies opposite its corner in g meets g.
bool far_edge_meets(const TriangleBoxes& mesh, int f, int g)
{
    const Face &corners = mesh.face(f), &others = mesh.face(g);
    for (int k = 0; k < 3; ++k) {
        const int a = corners[k], b = corners[(k + 1) % 3];
        const bool touches = std::any_of(others.begin(), others.end(), [&](int v) { return v == a || v == b; });
        if (!touches && segment_meets_triangle(mesh.vertex(a), mesh.vertex(b), mesh.triangle(g))) return true;
    }
    return false;
}

}  // namespace

std::vector<IntersectingPair> self_intersections(const std::vector<Vec3>& vertices, const std::vector<Face>& faces)
{
    if (faces.empty()) return {};
    const EmbreeDevice device;
    const TriangleBoxes mesh(device, vertices, faces);
    return collide(mesh.scene(), mesh.scene(), [&](int a, int b) {
        if (a == b || !mesh.has_area(a) || !mesh.has_area(b)) return false;
        const int shared = shared_corners(mesh.face(a), mesh.face(b));
        if (shared == 0) return triangles_meet(mesh.triangle(a), mesh.triangle(b));
        return shared == 1 && (far_edge_meets(mesh, a, b) || far_edge_meets(mesh, b, a));
    });
}

std::vector<IntersectingPair> mutual_intersections(const std::vector<Vec3>& vertices, const std::vector<Face>& faces,
                                                   const TriangleMesh& other)
{
    if (faces.empty() || other.faces.empty()) return {};
    const EmbreeDevice device;
    const TriangleBoxes mine(device, vertices, faces), theirs(device, other.vertices, other.faces);
    return collide(mine.scene(), theirs.scene(), [&](int a, int b) {
        return mine.has_area(a) && theirs.has_area(b) && triangles_meet(mine.triangle(a), theirs.triangle(b));
    });
}

}  // namespace selvage
