#include "bench/suites/embree_pairs.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <stdexcept>
#include <utility>

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include "host/embree/rays.hpp"

namespace selvage {
namespace {

struct CornerBox {
    std::array<float, 3> low, high;

    void add(const CornerBox& other)
    {
        for (int c = 0; c < 3; ++c) {
            low[c] = std::min(low[c], other.low[c]);
            high[c] = std::max(high[c], other.high[c]);
        }
    }
    bool overlaps(const CornerBox& other) const
    {
        return low[0] <= other.high[0] && other.low[0] <= high[0] && low[1] <= other.high[1] &&
               other.low[1] <= high[1] && low[2] <= other.high[2] && other.low[2] <= high[2];
    }
};

// Assigns each vertex and each edge to one of its faces, so that each pair of primitives is found once.
// Returns per face: bits 0-2 for the corners that it owns, bits 3-5 for the edges.
std::vector<std::uint8_t> owned_parts(const std::vector<Face>& faces, std::size_t particles)
{
    std::vector<std::uint8_t> owned(faces.size());
    std::vector<char> seen(particles);
    std::map<std::pair<int, int>, int> edges;
    for (std::size_t f = 0; f < faces.size(); ++f)
        for (int k = 0; k < 3; ++k) {
            const int a = faces[f][k], b = faces[f][(k + 1) % 3];
            if (!std::exchange(seen[a], 1)) owned[f] |= std::uint8_t(1 << k);
            if (edges.emplace(std::minmax(a, b), 0).second) owned[f] |= std::uint8_t(8 << k);
        }
    return owned;
}

}  // namespace

struct EmbreePairs::Impl {
    TreeSurface surface;
    std::vector<std::uint8_t> owned;
    std::vector<CornerBox> corner_box, face_box;
    RTCDevice device = nullptr;
    RTCScene scene = nullptr;
    RTCGeometry geometry = nullptr;

    ~Impl()
    {
        rtcReleaseGeometry(geometry);
        rtcReleaseScene(scene);
    }

    static void write_bounds(const RTCBoundsFunctionArguments* args)
    {
        const CornerBox& b = static_cast<const Impl*>(args->geometryUserPtr)->face_box[args->primID];
        *args->bounds_o = {b.low[0], b.low[1], b.low[2], 0, b.high[0], b.high[1], b.high[2], 0};
    }

    CornerBox box_of(const PairCandidate& pair, int first, int last) const
    {
        CornerBox box = corner_box[pair.corner[first]];
        for (int i = first + 1; i <= last; ++i) box.add(corner_box[pair.corner[i]]);
        return box;
    }

    void offer(const PairCandidate& pair, std::vector<PairCandidate>& found) const
    {
        const int second = pair.edges ? 2 : 1;
        for (int i = 0; i < second; ++i)
            for (int j = second; j < 4; ++j)
                if (surface.group_of[pair.corner[i]] == surface.group_of[pair.corner[j]]) return;
        if (box_of(pair, 0, second - 1).overlaps(box_of(pair, second, 3))) found.push_back(pair);
    }

    void meet(int face_a, int face_b, std::vector<PairCandidate>& found) const
    {
        const Face &a = surface.faces[face_a], &b = surface.faces[face_b];
        for (int k = 0; k < 3; ++k) {
            if (owned[face_a] >> k & 1) offer({{a[k], b[0], b[1], b[2]}, false}, found);
            if (owned[face_b] >> k & 1) offer({{b[k], a[0], a[1], a[2]}, false}, found);
            if (!(owned[face_a] >> (3 + k) & 1)) continue;
            for (int l = 0; l < 3; ++l)
                if (owned[face_b] >> (3 + l) & 1) offer({{a[k], a[(k + 1) % 3], b[l], b[(l + 1) % 3]}, true}, found);
        }
    }
};

namespace {

using FacePairs = tbb::enumerable_thread_specific<std::vector<std::pair<int, int>>>;

// Collects colliding faces. rtcCollide reports every pair in both orders, so one of them is dropped.
void collect(void* to, RTCCollision* collisions, unsigned count)
{
    std::vector<std::pair<int, int>>& pairs = static_cast<FacePairs*>(to)->local();
    for (unsigned k = 0; k < count; ++k) {
        const int a = int(collisions[k].primID0), b = int(collisions[k].primID1);
        if (a < b) pairs.emplace_back(a, b);
    }
}

}  // namespace

EmbreePairs::EmbreePairs(const EmbreeDevice& device, TreeSurface surface, Update update)
    : impl_(std::make_unique<Impl>())
{
    Impl& i = *impl_;
    i.surface = std::move(surface);
    i.owned = owned_parts(i.surface.faces, i.surface.group_of.size());
    i.corner_box.resize(i.surface.group_of.size());
    i.face_box.resize(i.surface.faces.size());
    i.device = static_cast<RTCDevice>(device.handle());
    i.scene = rtcNewScene(i.device);
    rtcSetSceneFlags(i.scene, RTC_SCENE_FLAG_DYNAMIC);  // Embree refits only the hierarchies of dynamic scenes
    rtcSetSceneBuildQuality(i.scene, RTC_BUILD_QUALITY_LOW);
    i.geometry = rtcNewGeometry(i.device, RTC_GEOMETRY_TYPE_USER);
    rtcSetGeometryBuildQuality(i.geometry, update == Update::refit ? RTC_BUILD_QUALITY_REFIT : RTC_BUILD_QUALITY_LOW);
    rtcSetGeometryUserPrimitiveCount(i.geometry, unsigned(i.surface.faces.size()));
    rtcSetGeometryUserData(i.geometry, &i);
    rtcSetGeometryBoundsFunction(i.geometry, Impl::write_bounds, nullptr);
    rtcAttachGeometry(i.scene, i.geometry);
}

EmbreePairs::~EmbreePairs() = default;

void EmbreePairs::move(const double* pos, int stride, double reach)
{
    Impl& i = *impl_;
    const float grown = float(0.5 * reach);
    tbb::parallel_for(std::size_t(0), i.corner_box.size(), [&](std::size_t v) {
        constexpr float far = std::numeric_limits<float>::infinity();
        for (int c = 0; c < 3; ++c) {  // rounded outwards
            const float x = float(pos[std::size_t(c) * std::size_t(stride) + v]);
            i.corner_box[v].low[c] = std::nextafter(x - grown, -far);
            i.corner_box[v].high[c] = std::nextafter(x + grown, far);
        }
    });
    tbb::parallel_for(std::size_t(0), i.face_box.size(), [&](std::size_t f) {
        const Face& face = i.surface.faces[f];
        i.face_box[f] = i.corner_box[face[0]];
        i.face_box[f].add(i.corner_box[face[1]]);
        i.face_box[f].add(i.corner_box[face[2]]);
    });
    rtcCommitGeometry(i.geometry);
    rtcCommitScene(i.scene);
    if (rtcGetDeviceError(i.device) != RTC_ERROR_NONE)
        throw std::runtime_error("Embree failed to build a hierarchy of cloth");
}

std::vector<PairCandidate> EmbreePairs::candidates() const
{
    FacePairs collected;
    rtcCollide(impl_->scene, impl_->scene, collect, &collected);
    std::vector<std::pair<int, int>> faces;
    for (const auto& of_thread : collected) faces.insert(faces.end(), of_thread.begin(), of_thread.end());
    tbb::enumerable_thread_specific<std::vector<PairCandidate>> found;
    tbb::parallel_for(std::size_t(0), faces.size(),
                      [&](std::size_t k) { impl_->meet(faces[k].first, faces[k].second, found.local()); });
    std::vector<PairCandidate> all;
    for (const auto& of_thread : found) all.insert(all.end(), of_thread.begin(), of_thread.end());
    return all;
}

}  // namespace selvage
