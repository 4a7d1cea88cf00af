#include "host/run/render_run.hpp"

#include <filesystem>
#include <map>

#include "host/mesh/polygon_triangles.hpp"
#include "host/model/body.hpp"
#include "host/render/picture.hpp"
#include "host/scene/body_model.hpp"
#include "io/errors.hpp"
#include "io/mesh/mesh_obj.hpp"
#include "io/run/trajectory.hpp"
#include "io/scene/read_scene.hpp"
#include "io/steady_read.hpp"

namespace selvage {
namespace {

// A corner of a face at rest: its panel and place there. Files of earlier versions have no places.
struct RestCorner {
    int panel;
    Vec2 place;
    bool operator==(const RestCorner& other) const { return panel == other.panel && place == other.place; }
};

RestCorner rest_corner(const TrajectoryLayout& layout, const std::vector<int>& face_panel, std::size_t face, int corner)
{
    return {face_panel[face], layout.rest_corners.empty() ? Vec2(0, 0) : layout.rest_corners[face][corner]};
}

// In files of earlier versions a face belongs to the panel of most of its corners, which may fail at seams.
std::vector<int> face_panels(const TrajectoryLayout& layout)
{
    if (!layout.triangle_panel.empty()) return layout.triangle_panel;
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
    std::error_code error;
    if (text.find("keyframe") == std::string::npos && text.find("sequence") == std::string::npos) {
        if (std::filesystem::exists(file, error))
            meshes.push_back(triangle_mesh(read_obj(file, LengthUnit::m, Axis::z)));
        return meshes;
    }
    const double bodies_time = run.stem() == "sewing" ? 0 : time;  // they wait until the garment is sewn
    std::vector<Finding> known;                                    // the run has told of them
    for (const Body& body : build_bodies(read_scene_text(text, reader.layout().scene_file), known))
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

std::vector<std::array<int, 2>> seam_edges(const TrajectoryLayout& layout)
{
    const std::vector<int> face_panel = face_panels(layout);
    std::map<std::array<int, 2>, std::array<RestCorner, 2>> places;
    std::vector<std::array<int, 2>> seams;
    for (std::size_t f = 0; f < layout.triangles.size(); ++f)
        for (int k = 0; k < 3; ++k) {
            int low = k, high = (k + 1) % 3;
            if (layout.triangles[f][low] > layout.triangles[f][high]) std::swap(low, high);
            const std::array<int, 2> edge{layout.triangles[f][low], layout.triangles[f][high]};
            const std::array<RestCorner, 2> here{rest_corner(layout, face_panel, f, low),
                                                 rest_corner(layout, face_panel, f, high)};
            const auto [at, fresh] = places.try_emplace(edge, here);
            if (!fresh && at->second != here) seams.push_back(edge);
        }
    return seams;
}

void render_run(const std::string& run_h5, const std::string& png, int frame, int width, const std::string& body_obj)
{
    PictureCloth picture;
    int at = frame;
    const TrajectoryReader reader = read_steadily(run_h5, [&] {
        TrajectoryReader run(run_h5);
        const int count = run.frame_count();
        at = frame < 0 ? count + frame : frame;
        if (at < 0 || at >= count)
            throw InputError({run_h5, 0, 0, "frame"}, std::to_string(frame),
                             "a frame from 0 to " + std::to_string(count - 1));
        picture.positions = run.read_frame(at);
        return run;
    });
    picture.faces = reader.layout().triangles;
    picture.face_panel = face_panels(reader.layout());
    picture.seam_edges = seam_edges(reader.layout());
    const std::vector<TriangleMesh> bodies = bodies_at(reader, run_h5, reader.scalars(at).time);
    if (!body_obj.empty()) write_bodies(bodies, body_obj);
    PictureOptions options;
    options.width = width;
    write_png(png, render_picture(picture, bodies, options));
}

}  // namespace selvage
