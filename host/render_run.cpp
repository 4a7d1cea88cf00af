#include "host/render_run.hpp"

#include <filesystem>
#include <map>

#include "host/render/picture.hpp"
#include "io/errors.hpp"
#include "io/mesh_obj.hpp"
#include "io/trajectory.hpp"

namespace selvage {
namespace {

// Edges whose two faces belong to different panels.
std::vector<std::array<int, 2>> panel_borders(const std::vector<Face>& faces, const std::vector<int>& face_panel)
{
    std::map<std::array<int, 2>, int> panel_of_edge;
    std::vector<std::array<int, 2>> borders;
    for (std::size_t f = 0; f < faces.size(); ++f)
        for (int k = 0; k < 3; ++k) {
            const int a = faces[f][k], b = faces[f][(k + 1) % 3];
            const auto [at, fresh] = panel_of_edge.try_emplace({std::min(a, b), std::max(a, b)}, face_panel[f]);
            if (!fresh && at->second != face_panel[f]) borders.push_back(at->first);
        }
    return borders;
}

// A face belongs to the panel whose flat edges it keeps: the panel of most of its corners.
std::vector<int> face_panels(const TrajectoryLayout& layout)
{
    std::vector<int> panels;
    for (const Face& f : layout.triangles) {
        const int a = layout.panel[f[0]], b = layout.panel[f[1]], c = layout.panel[f[2]];
        panels.push_back(b == c ? b : a);
    }
    return panels;
}

}  // namespace

void render_run(const std::string& run_h5, const std::string& png, int frame, int width)
{
    const TrajectoryReader reader(run_h5);
    const int count = reader.frame_count(), at = frame < 0 ? count + frame : frame;
    if (at < 0 || at >= count)
        throw InputError({run_h5, 0, 0, "frame"}, std::to_string(frame), "a frame from 0 to " + std::to_string(count - 1));
    PictureCloth picture;
    picture.positions = reader.read_frame(at);
    picture.faces = reader.layout().triangles;
    picture.face_panel = face_panels(reader.layout());
    picture.seam_edges = panel_borders(picture.faces, picture.face_panel);
    std::vector<TriangleMesh> bodies;
    const std::string body = (std::filesystem::path(run_h5).parent_path() / "body.obj").string();
    if (std::filesystem::exists(body)) bodies.push_back(read_obj(body, "m", "z"));
    PictureOptions options;
    options.width = width;
    write_png(png, render_picture(picture, bodies, options));
}

}  // namespace selvage
