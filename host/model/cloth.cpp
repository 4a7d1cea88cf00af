#include "host/model/cloth.hpp"

#include <algorithm>
#include <utility>

namespace selvage {

std::vector<Face> outward_faces(const Cloth& cloth)
{
    std::vector<Face> faces = cloth.faces;
    for (const ClothPanel& panel : cloth.panels)
        for (int f = panel.first_face; panel.reversed && f < panel.first_face + panel.face_count; ++f)
            std::swap(faces[f][1], faces[f][2]);
    return faces;
}

bool seams_are_closed(const Cloth& cloth)
{
    return std::all_of(cloth.seam_pairs.begin(), cloth.seam_pairs.end(),
                       [&](const auto& pair) { return cloth.positions[pair[0]] == cloth.positions[pair[1]]; });
}

void append_cloth(Cloth& to, const Cloth& other)
{
    const int vertices = int(to.positions.size()), faces = int(to.faces.size()), panels = int(to.panels.size());
    const int sides = int(to.outline.size()), pairs = int(to.seam_pairs.size());
    const auto append = [](auto& list, const auto& more) { list.insert(list.end(), more.begin(), more.end()); };
    append(to.panel_coordinates, other.panel_coordinates);
    append(to.positions, other.positions);
    for (Finding finding : other.findings) {
        for (int& face : finding.faces) face += faces;
        for (auto& pair : finding.pairs) pair = {pair[0] + faces, pair[1] + faces};
        to.findings.push_back(std::move(finding));
    }
    for (const Face& face : other.faces)
        to.faces.push_back({face[0] + vertices, face[1] + vertices, face[2] + vertices});
    for (ClothPanel panel : other.panels) {
        panel.first_vertex += vertices;
        panel.first_face += faces;
        to.panels.push_back(std::move(panel));
    }
    for (OutlineSamples samples : other.outline) {
        samples.panel += panels;
        for (int& vertex : samples.vertices) vertex += vertices;
        to.outline.push_back(std::move(samples));
    }
    for (Seam seam : other.seams) {
        seam.side_a += sides;
        seam.side_b += sides;
        seam.first_pair += pairs;
        to.seams.push_back(seam);
    }
    for (Elastic elastic : other.elastics) {
        for (int& vertex : elastic.vertices) vertex += vertices;
        to.elastics.push_back(std::move(elastic));
    }
    for (const auto& [a, b] : other.seam_pairs) to.seam_pairs.push_back({a + vertices, b + vertices});
    for (const int vertex : other.pinned) to.pinned.push_back(vertex + vertices);
    for (PinMotion motion : other.pin_motions) {
        for (int& vertex : motion.vertices) vertex += vertices;
        to.pin_motions.push_back(std::move(motion));
    }
}

double typical_edge(const Cloth& cloth)
{
    double total = 0;
    for (const Face& f : cloth.faces)
        for (int k = 0; k < 3; ++k)
            total += (cloth.panel_coordinates[f[k]] - cloth.panel_coordinates[f[(k + 1) % 3]]).norm();
    return cloth.faces.empty() ? 0.01 : total / (3 * double(cloth.faces.size()));
}

double least_height(const Cloth& cloth, int face)
{
    const Face& f = cloth.faces[face];
    const Vec2 a = cloth.panel_coordinates[f[1]] - cloth.panel_coordinates[f[0]];
    const Vec2 b = cloth.panel_coordinates[f[2]] - cloth.panel_coordinates[f[0]];
    const double longest = std::sqrt(std::max({a.squaredNorm(), b.squaredNorm(), (b - a).squaredNorm()}));
    return std::abs(a.x() * b.y() - a.y() * b.x()) / longest;
}

}  // namespace selvage
