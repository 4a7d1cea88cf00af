#include "host/run/cloth_picture.hpp"

#include "host/run/measure.hpp"

namespace selvage {
std::vector<int> representatives(const Topology& topology)
{
    std::vector<int> first(topology.particle_count, -1), representative(topology.particle_of.size());
    for (int v = 0; v < int(topology.particle_of.size()); ++v) {
        int& of_particle = first[topology.particle_of[v]];
        if (of_particle < 0) of_particle = v;
        representative[v] = of_particle;
    }
    return representative;
}

std::vector<Face> shared_faces(const Cloth& cloth, const Topology& topology)
{
    const std::vector<int> representative = representatives(topology);
    std::vector<Face> faces = outward_faces(cloth);
    for (Face& face : faces)
        for (int& v : face) v = representative[v];
    return faces;
}

Image draw_cloth(const Cloth& cloth, const std::vector<TriangleMesh>& bodies, const std::vector<Vec3>& positions,
                 const std::vector<Face>& faces, const Topology& topology, PictureOptions options)
{
    const std::vector<int> representative = representatives(topology);
    PictureCloth picture;
    picture.positions = positions;
    picture.faces = faces;
    picture.face_panel = face_panels(cloth);
    for (const Seam& seam : cloth.seams)
        for (int k = seam.first_pair; k + 1 < seam.first_pair + seam.pair_count; ++k)
            picture.seam_edges.push_back(
                {representative[cloth.seam_pairs[k][0]], representative[cloth.seam_pairs[k + 1][0]]});
    if (!cloth.seams.empty()) options.views = PictureViews::front_and_back;
    return render_picture(picture, bodies, options);
}

}  // namespace selvage
