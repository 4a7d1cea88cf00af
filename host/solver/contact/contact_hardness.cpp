#include "host/solver/contact/contact_hardness.hpp"

#include <algorithm>

#include "host/model/motion_reach.hpp"
#include "host/solver/contact/contact_gaps.hpp"

namespace selvage {

ContactHardness local_hardness(const Topology& topology, const Cloth& cloth, const FabricTable& fabrics,
                               const std::vector<Body>& bodies, const Vec3& down, double stiffness, double gap)
{
    double heaviest = 0;
    for (const auto& [name, fabric] : fabrics) heaviest = std::max(heaviest, fabric.areal_density);
    ContactHardness hardness{
        std::vector<double>(std::size_t(topology.particle_count)), std::vector<double>(bodies.size(), 1.0), {}};
    for (const ClothPanel& panel : cloth.panels) {
        const double of_panel = fabrics.at(panel.fabric).areal_density / heaviest;
        for (int v = panel.first_vertex; v < panel.first_vertex + panel.vertex_count; ++v) {
            double& of_particle = hardness.of_particle[topology.particle_of[v]];
            of_particle = std::max(of_particle, of_panel);
        }
    }
    for (std::size_t b = 0; b < bodies.size(); ++b) {
        if (!bodies[b].motion) continue;
        // What a body drives before it has to gain its speed within the gap.
        const double speed = bodies[b].motion->highest_speed(box_of(bodies[b].mesh.vertices));
        hardness.of_body[b] = std::max(1.0, heaviest * speed * speed / (gap * stiffness));
    }
    hardness.of_pairs = hardness.of_particle;
    const std::vector<int> piece = pieces_of(cloth);
    std::vector<Box> start(piece.size());  // of each piece, by its number
    std::vector<double> driven(piece.size(), 1.0);
    for (std::size_t v = 0; v < piece.size(); ++v) start[piece[v]].extend(cloth.positions[v]);
    for (std::size_t p = 0; p < start.size(); ++p) {
        if (start[p].isEmpty()) continue;
        const Box reach = swing_reach(start[p], down);
        for (std::size_t b = 0; b < bodies.size(); ++b)
            if (hardness.of_body[b] > driven[p] && moves_within(bodies[b], reach)) driven[p] = hardness.of_body[b];
    }
    for (std::size_t v = 0; v < piece.size(); ++v) {
        double& of_pairs = hardness.of_pairs[topology.particle_of[v]];
        of_pairs = std::max(of_pairs, hardness.of_particle[topology.particle_of[v]] * driven[piece[v]]);
    }
    return hardness;
}

}  // namespace selvage
