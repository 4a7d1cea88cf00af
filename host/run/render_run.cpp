#include "host/run/render_run.hpp"

#include <filesystem>
#include <map>

#include "host/model/body.hpp"
#include "host/render/picture.hpp"
#include "host/scene/body_model.hpp"
#include "io/errors.hpp"
#include "io/mesh/mesh_obj.hpp"
#include "io/run/trajectory.hpp"
#include "io/scene/read_scene.hpp"

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

// The bodies as they are in a frame: those of body.obj, which shows the last one, unless they move.
std::vector<TriangleMesh> bodies_at(const TrajectoryReader& reader, const std::string& run_h5, double time)
{
    std::vector<TriangleMesh> meshes;
    const std::filesystem::path run(run_h5);
    const std::string file = (run.parent_path() / "body.obj").string(), &text = reader.layout().scene_text;
    // The scene's own files need not be there any more: it is read only where something may move.
    if (text.find("keyframe") == std::string::npos && text.find("sequence") == std::string::npos) {
        if (std::filesystem::exists(file)) meshes.push_back(read_obj(file, LengthUnit::m, Axis::z));
        return meshes;
    }
    const double bodies_time = run.filename() == "sewing.h5" ? 0 : time;  // they wait until the garment is sewn
    for (const Body& body : build_bodies(read_scene_text(text, reader.layout().scene_file)))
        meshes.push_back(body_mesh_at(body, bodies_time));
    return meshes;
}

void write_bodies(const std::vector<TriangleMesh>& bodies, const std::string& path)
{
    std::vector<ObjObject> objects;
    for (std::size_t b = 0; b < bodies.size(); ++b)
        objects.push_back({"body_" + std::to_string(b), bodies[b].vertices, bodies[b].faces});
    write_obj(path, objects);
}

}  // namespace

void render_run(const std::string& run_h5, const std::string& png, int frame, int width, const std::string& body_obj)
{
    const TrajectoryReader reader(run_h5);
    const int count = reader.frame_count(), at = frame < 0 ? count + frame : frame;
    if (at < 0 || at >= count)
        throw InputError({run_h5, 0, 0, "frame"}, std::to_string(frame),
                         "a frame from 0 to " + std::to_string(count - 1));
    PictureCloth picture;
    picture.positions = reader.read_frame(at);
    picture.faces = reader.layout().triangles;
    picture.face_panel = face_panels(reader.layout());
    picture.seam_edges = panel_borders(picture.faces, picture.face_panel);
    const std::vector<TriangleMesh> bodies = bodies_at(reader, run_h5, reader.scalars(at).time);
    if (!body_obj.empty()) write_bodies(bodies, body_obj);
    PictureOptions options;
    options.width = width;
    write_png(png, render_picture(picture, bodies, options));
}

}  // namespace selvage
