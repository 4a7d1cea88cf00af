#include "host/model/body.hpp"

#include <algorithm>

namespace selvage {

TriangleMesh body_mesh_at(const Body& body, double time)
{
    TriangleMesh mesh = body.mesh;
    if (!body.motion) return mesh;
    if (body.motion->deforms()) body.motion->vertices_at(time, mesh.vertices);
    const Placement place = body.motion->placement(time);
    for (Vec3& vertex : mesh.vertices) vertex = place * vertex;
    return mesh;
}

bool any_moves(const std::vector<Body>& bodies)
{
    return std::any_of(bodies.begin(), bodies.end(), [](const Body& body) { return body.motion != nullptr; });
}

}  // namespace selvage
