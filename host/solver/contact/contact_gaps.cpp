#include "host/solver/contact/contact_gaps.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "host/collision/ccd.hpp"
#include "host/solver/contact/contact_tuning.hpp"
#include "host/solver/contact/crossing_flags.hpp"

namespace selvage {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

// The mean length of the edges of each piece at rest, by its number [m].
std::vector<double> edges_of_pieces(const Cloth& cloth, const std::vector<int>& piece)
{
    std::vector<double> total(piece.size()), count(piece.size());
    for (const Face& f : cloth.faces)
        for (int k = 0; k < 3; ++k) {
            total[piece[f[0]]] += (cloth.panel_coordinates[f[k]] - cloth.panel_coordinates[f[(k + 1) % 3]]).norm();
            ++count[piece[f[0]]];
        }
    for (std::size_t p = 0; p < total.size(); ++p) total[p] = count[p] > 0 ? total[p] / count[p] : infinite;
    return total;
}

}  // namespace

std::vector<int> pieces_of(const Cloth& cloth)
{
    std::vector<int> parent(cloth.positions.size());
    std::iota(parent.begin(), parent.end(), 0);
    const auto root = [&parent](int v) {
        while (parent[v] != v) v = parent[v] = parent[parent[v]];
        return v;
    };
    const auto join = [&](int a, int b) { parent[std::max(root(a), root(b))] = std::min(root(a), root(b)); };
    for (const Face& f : cloth.faces) {
        join(f[0], f[1]);
        join(f[0], f[2]);
    }
    for (const auto& [a, b] : cloth.seam_pairs) join(a, b);
    std::vector<int> piece(parent.size());
    for (int v = 0; v < int(parent.size()); ++v) piece[v] = root(v);
    return piece;
}

ContactGaps::ContactGaps(const Topology& topology, const Cloth& cloth, const FabricTable& fabrics, double least)
    : largest_(0)
{
    const std::size_t particles = std::size_t(topology.particle_count);
    const std::vector<int> piece = pieces_of(cloth);
    const std::vector<double> edge = edges_of_pieces(cloth, piece);
    wanted_.assign(particles, least);
    room_.assign(particles, infinite);
    piece_.resize(particles);
    panel_.assign(particles, -2);
    rest_.resize(particles);
    for (int p = 0; p < int(cloth.panels.size()); ++p) {
        const ClothPanel& panel = cloth.panels[p];
        for (int v = panel.first_vertex; v < panel.first_vertex + panel.vertex_count; ++v) {
            const int at = topology.particle_of[v];
            wanted_[at] = std::max(wanted_[at], fabrics.at(panel.fabric).thickness);
            piece_[at] = piece[v];
            panel_[at] = panel_[at] == -2 ? p : -1;
            rest_[at] = cloth.panel_coordinates[v];
        }
    }
    for (std::size_t v = 0; v < particles; ++v)
        wanted_[v] = std::min(wanted_[v], ContactTuning::gap_of_edge * edge[piece_[v]]);
    for (std::size_t f = 0; f < cloth.faces.size(); ++f)
        for (int particle : topology.faces[f]) room_[particle] = std::min(room_[particle], least_height(cloth, int(f)));
    if (particles > 0) largest_ = *std::max_element(wanted_.begin(), wanted_.end());
    bool alike = true;
    for (std::size_t v = 0; v < particles; ++v)
        alike = alike && wanted_[v] == largest_ && ContactTuning::gap_of_rest * room_[v] >= largest_;
    if (alike) *this = ContactGaps(largest_);
}

double ContactGaps::largest_of_bodies() const { return ContactTuning::body_gap * largest_; }

double ContactGaps::of(const PairCandidate& candidate) const
{
    if (!has_body(candidate)) return of_cloth(candidate);
    return candidate.edges || candidate.corner[0] < 0 ? ContactTuning::body_gap * of_cloth(candidate) : 0;
}

double ContactGaps::local(const PairCandidate& candidate) const
{
    const int first = candidate.edges ? 2 : 1;
    double side[2] = {infinite, infinite}, room = infinite;
    for (int i = 0; i < 4; ++i) {
        const int v = candidate.corner[i];
        if (v < 0) continue;
        side[i >= first] = std::min(side[i >= first], wanted_[v]);
        room = std::min(room, room_[v]);
    }
    if (has_body(candidate)) return std::min(side[0], side[1]);
    const double gap = 0.5 * (side[0] + side[1]);
    // Vertices are no nearer to what they are no corner of than the triangles around them are high.
    if (ContactTuning::gap_of_rest * room >= gap || piece_[candidate.corner[0]] != piece_[candidate.corner[3]])
        return gap;
    const int panel = panel_[candidate.corner[0]];
    const bool flat = panel >= 0 && std::all_of(candidate.corner.begin(), candidate.corner.end(),
                                                [&](int v) { return panel_[v] == panel; });
    return std::min(gap, ContactTuning::gap_of_rest * (flat ? rest_distance(candidate) : room));
}

double ContactGaps::rest_distance(const PairCandidate& candidate) const
{
    PairCorners x;
    for (int i = 0; i < 4; ++i) x[i] = {rest_[candidate.corner[i]].x(), rest_[candidate.corner[i]].y(), 0};
    return pair_distance(x, candidate.edges);
}

}  // namespace selvage
