#include "host/render/scene_tracer.hpp"

#include <algorithm>

#include <tbb/task_arena.h>

namespace selvage {
namespace {

constexpr float relative_lift = 1e-5f;  // of the scene's size: about a hundred times the rounding in single precision

void attach(RTCDevice device, RTCScene scene, const DrawnMesh& mesh, int id)
{
    const EmbreeGeometry geometry(rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE));
    require_no_embree_error(device, "make a triangle mesh");
    // Copied: Embree may read up to 16 bytes from the last vertex, which a shared buffer would have to allow for.
    void* vertices = rtcSetNewGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                             sizeof(Vec3f), mesh.positions.size());
    void* faces = rtcSetNewGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, sizeof(Face),
                                          mesh.faces.size());
    require_no_embree_error(device, "allocate a triangle mesh");
    std::copy(mesh.positions.begin(), mesh.positions.end(), static_cast<Vec3f*>(vertices));
    std::copy(mesh.faces.begin(), mesh.faces.end(), static_cast<Face*>(faces));
    rtcCommitGeometry(geometry.get());
    rtcAttachGeometryByID(scene, geometry.get(), unsigned(id));
    require_no_embree_error(device, "add a triangle mesh");
}

RTCRay embree_ray(const Ray& ray)
{
    RTCRay result{};
    result.org_x = ray.origin.x(), result.org_y = ray.origin.y(), result.org_z = ray.origin.z();
    result.dir_x = ray.direction.x(), result.dir_y = ray.direction.y(), result.dir_z = ray.direction.z();
    result.tfar = std::numeric_limits<float>::infinity();
    result.mask = ~0u;
    return result;
}

}  // namespace

SceneTracer::SceneTracer(std::vector<const DrawnMesh*> meshes) : meshes_(std::move(meshes)), device_(open_embree())
{
    scene_ = make_embree_scene(device_.get(), RTC_SCENE_FLAG_ROBUST, RTC_BUILD_QUALITY_MEDIUM);
    float size = 0;
    for (int id = 0; id < int(meshes_.size()); ++id) {
        const DrawnMesh& mesh = *meshes_[std::size_t(id)];
        if (mesh.faces.empty()) continue;
        attach(device_.get(), scene_.get(), mesh, id);
        for (const Face& face : mesh.faces)
            for (const int vertex : face)
                size = std::max(size, mesh.positions[std::size_t(vertex)].cwiseAbs().maxCoeff());
    }
    lift_ = relative_lift * std::min(size, 10.f);
    // One thread: a parallel build may order faces differently, and a ray through a shared edge takes the first.
    tbb::task_arena(1).execute([&] { rtcJoinCommitScene(scene_.get()); });
    require_no_embree_error(device_.get(), "build a scene");
}

std::optional<SurfaceHit> SceneTracer::first_hit(const Ray& ray) const
{
    RTCRayHit query{};
    query.ray = embree_ray(ray);
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    RayContext context = make_ray_context();
    find_first_hit(scene_.get(), query, context, RayOrder::neighbouring);
    if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;

    SurfaceHit hit;
    hit.mesh = int(query.hit.geomID);
    hit.face = int(query.hit.primID);
    hit.distance = query.ray.tfar;
    const DrawnMesh& mesh = *meshes_[std::size_t(hit.mesh)];
    const auto face = std::size_t(hit.face);
    const float u = query.hit.u, v = query.hit.v;
    const std::array<float, 3> weight{1 - u - v, u, v};
    hit.position = mesh.point(hit.face, u, v);
    hit.back_side = mesh.face_normals[face].dot(ray.direction) > 0;
    const float side = hit.back_side ? -1.f : 1.f;
    hit.face_normal = side * mesh.face_normals[face];

    Vec3f normal = Vec3f::Zero(), raise = Vec3f::Zero();
    for (std::size_t i = 0; i < 3; ++i) {
        const Vec3f corner_normal = side * mesh.normals[face][i];
        normal += weight[i] * corner_normal;
        const float below =
            std::min(0.f, (hit.position - mesh.positions[std::size_t(mesh.faces[face][i])]).dot(corner_normal));
        raise -= weight[i] * below * corner_normal;
    }
    hit.normal = normal.normalized();
    hit.light_origin = hit.position + raise + lift_ * hit.face_normal;
    return hit;
}

bool SceneTracer::is_blocked(const Ray& ray) const
{
    RTCRay query = embree_ray(ray);
    find_any_hit(scene_.get(), query);
    return query.tfar < 0;
}

}  // namespace selvage
