#include "host/scene/memory_plan.hpp"

#include <algorithm>

#include "host/collision/body_bvh.hpp"
#include "host/collision/body_surface.hpp"
#include "host/collision/cloth_tree.hpp"
#include "host/mesh/triangle_tree.hpp"
#include "host/render/drawn_mesh.hpp"
#include "host/render/pixel_buffer.hpp"
#include "host/solver/contact/ccd_filter.hpp"
#include "host/solver/contact/cloth_body_contact.hpp"
#include "host/solver/contact/contact_pairs.hpp"
#include "host/solver/state/snapshot.hpp"
#include "io/memory.hpp"

namespace selvage {
namespace {

struct MemoryTuning {
    // Arrays with three numbers for each particle that the solver holds beside the state: five of Newton's method, the
    // static force, five of an integrator (BDF2; others have fewer, one has six), the place that ways into bodies are
    // looked from, and the way that a step goes through contact.
    static constexpr int vectors = 13;
    // Pairs in contact, and candidates for it, for each vertex: what a garment of two layers has. Heaps have more.
    static constexpr int pairs = 1, candidates = 3;
    // Of a hierarchy of Embree for each of its triangles, measured with heaptrack (3.13, 400 000 triangles): for
    // queries of bodies, built at high quality, and for pictures.
    static constexpr std::size_t query_hierarchy = 240, picture_hierarchy = 150;
    // What libraries take once a run uses them: HDF5, Embree's devices, TBB's threads. Measured on scenes of 1000
    // vertices.
    static constexpr std::size_t libraries = std::size_t(8) << 20;
    static constexpr double picture_aspect = 1.0;                 // height over width of a view; between 0.62 and 1.3
    static constexpr std::size_t obj_vertex = 60, obj_face = 25;  // text of a line [bytes]
    static constexpr int obj_copies = 3;                          // a text that grows by doubling, while it is copied
};

std::size_t mesh_bytes(const TriangleMesh& mesh)
{
    return mesh.vertices.size() * sizeof(Vec3) + mesh.faces.size() * sizeof(Face);
}

std::size_t topology_bytes(const Topology& topology)
{
    return topology.particle_of.size() * sizeof(int) + topology.faces.size() * sizeof(Face) +
           topology.hinges.size() * (sizeof(std::array<int, 4>) + sizeof(std::array<int, 2>)) +
           topology.stitches.size() * sizeof(std::array<int, 2>) + topology.springs.size() * sizeof(Spring);
}

std::size_t kept_bytes(const mesh_sizes& size, const FieldSet& fields)
{
    FieldSet kept;
#define KEPT(name, reason) kept.set(std::size_t(Field::name));
#include "kernels/fields.def"
    return field_bytes(size, fields & kept);
}

int faces_within(const TriangleMesh& mesh, const Box& reach)
{
    return int(std::count_if(mesh.faces.begin(), mesh.faces.end(), [&](const Face& f) {
        Box box;
        for (int v : f) box.extend(mesh.vertices[v]);
        return reach.intersects(box);
    }));
}

// Of BodyQuery and what a particle remembers in it.
std::size_t query_bytes(const ClothModel& model, int particles)
{
    const Box reach = cloth_reach(model.cloth);
    const bool moves = any_moves(model.bodies);
    std::size_t total = std::size_t(particles) *
                        (sizeof(Vec3) + sizeof(double) + 2 * sizeof(int) + (moves ? sizeof(double) + sizeof(Vec3) : 0));
    for (const Body& body : model.bodies) {
        if (body.kind != Body::Kind::mesh) continue;
        const std::size_t within = std::size_t(faces_within(body.mesh, reach));
        total += BodySurface::bytes_of(body.mesh, body.motion != nullptr) + BodyBvh::bytes_of(within) +
                 within * MemoryTuning::query_hierarchy;
    }
    return total;
}

// Of contact of cloth with itself and of its faces with bodies: the tree, the step filter, tangles, moving bodies.
std::size_t cloth_contact_bytes(const PhaseMemory& phase)
{
    const std::size_t particles = std::size_t(phase.size.vertex_count);
    std::size_t faces = phase.topology.faces.size(), corners = particles, bodies = 0;
    for (const Body& body : phase.model.bodies) {
        if (!meets_bodies(phase.params) || clear_by_vertices(body, phase.model.cloth)) continue;
        faces += body.mesh.faces.size();
        corners += body.mesh.vertices.size();
        // MovingBoundary has the body, its corners and their goals, Tangles a mesh with a tree, the state the corners.
        bodies += 2 * mesh_bytes(body.mesh) + 3 * body.mesh.vertices.size() * sizeof(Vec3) +
                  TriangleTree::bytes_of(body.mesh.faces.size());
    }
    const std::size_t tangles = phase.topology.faces.size() * sizeof(Face) + 3 * particles;
    const std::size_t filter =
        corners * (sizeof(Vec3) + 2 * sizeof(float)) + MemoryTuning::candidates * particles * sizeof(PairDistance);
    const std::size_t friction = 3 * particles * sizeof(double);  // with areas and hardness
    return ClothTree::bytes_of(faces, corners) + MemoryTuning::candidates * particles * sizeof(PairCandidate) + filter +
           tangles + friction + bodies;
}

std::size_t picture_bytes(const Scene& scene, const ClothModel& model)
{
    std::size_t vertices = model.cloth.positions.size(), faces = model.cloth.faces.size();
    for (const Body& body : model.bodies) {
        vertices += body.mesh.vertices.size();
        faces += body.mesh.faces.size();
    }
    const std::size_t mesh =
        vertices * (sizeof(Vec3f) + sizeof(int)) + faces * (2 * sizeof(Face) + sizeof(int) + 4 * sizeof(Vec3f));
    const std::size_t hierarchy = vertices * sizeof(Vec3f) + faces * (sizeof(Face) + MemoryTuning::picture_hierarchy);
    const double width = 0.5 * scene.output.picture_width;
    const std::size_t pixels = std::size_t(width * width * MemoryTuning::picture_aspect);
    return mesh + hierarchy + pixels * (sizeof(Pixel) + 4 * 3);
}

std::size_t crossing_bytes(const ClothModel& model)
{
    std::size_t body = 0;
    for (const Body& b : model.bodies)
        body = std::max(body, mesh_bytes(b.mesh) + TriangleTree::bytes_of(b.mesh.faces.size()));
    const std::size_t faces = model.cloth.faces.size();
    return model.cloth.positions.size() * sizeof(Vec3) + 2 * faces * sizeof(Face) + TriangleTree::bytes_of(faces) +
           body;
}

std::size_t obj_bytes(std::size_t vertices, std::size_t faces)
{
    return MemoryTuning::obj_copies * (vertices * MemoryTuning::obj_vertex + faces * MemoryTuning::obj_face);
}

}  // namespace

std::size_t total_bytes(const std::vector<MemoryPart>& parts)
{
    std::size_t total = 0;
    for (const MemoryPart& part : parts) total += part.bytes;
    return total;
}

std::vector<MemoryPart> phase_memory(const PhaseMemory& phase)
{
    mesh_sizes with_pairs = phase.size;
    const bool self = meets_itself(phase.params);
    if (self) {
        with_pairs.pair_count = MemoryTuning::pairs * phase.size.vertex_count;
        with_pairs.pair_slot_count = 4 * with_pairs.pair_count;
        with_pairs.pair_stride = padded_stride(with_pairs.pair_count);
        with_pairs.pair_slot_stride = padded_stride(with_pairs.pair_slot_count);
    }
    std::vector<MemoryPart> parts;
    parts.push_back({"state", field_bytes(with_pairs, phase.fields) + topology_bytes(phase.topology)});
    parts.push_back({"linear_solver", phase.solver_bytes});
    parts.push_back({"vectors", MemoryTuning::vectors * field_bytes(phase.size, field_set({Field::pos})) +
                                    kept_bytes(phase.size, phase.fields)});
    if (meets_bodies(phase.params)) parts.push_back({"body_query", query_bytes(phase.model, phase.size.vertex_count)});
    if (self) parts.push_back({"cloth_contact", cloth_contact_bytes(phase)});
    return parts;
}

std::vector<MemoryPart> end_memory(const Scene& scene, const ClothModel& model)
{
    std::size_t copies = model.cloth.positions.size() * sizeof(Vec3), body_vertices = 0, body_faces = 0;
    for (const Body& body : model.bodies) {
        copies += mesh_bytes(body.mesh);
        body_vertices += body.mesh.vertices.size();
        body_faces += body.mesh.faces.size();
    }
    const std::size_t picture = scene.output.picture ? picture_bytes(scene, model) : 0;
    const std::size_t texts = std::max(obj_bytes(2 * model.cloth.positions.size(), 2 * model.cloth.faces.size()),
                                       obj_bytes(body_vertices, body_faces));
    return {{"results", copies + std::max({picture, crossing_bytes(model), texts})}};
}

MemoryPart present_memory()
{
    return {"program_and_model", std::size_t(resident_memory_bytes()) + MemoryTuning::libraries};
}

}  // namespace selvage
