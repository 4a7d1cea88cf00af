#include "host/render/picture.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include <Eigen/Geometry>
#include "host/render/camera.hpp"
#include "host/render/framing.hpp"
#include "host/render/scene_tracer.hpp"
#include "host/render/shading.hpp"
#include "host/render/view.hpp"

namespace selvage {
namespace {

constexpr float margin = 0.05f;                    // kept free on each side of a view, over its size [1]
constexpr float flattest = 0.62f, tallest = 1.3f;  // limits of height / width of one view
const Vec3f warning_colour(0.85f, 0.09f, 0.03f);

void check(const PictureCloth& cloth, const PictureOptions& options)
{
    if (options.width < 16)
        throw std::invalid_argument("picture width is " + std::to_string(options.width) +
                                    " pixels, expected at least 16");
    if (options.samples_per_axis < 1)
        throw std::invalid_argument("samples_per_axis is " + std::to_string(options.samples_per_axis) +
                                    ", expected at least 1");
    if (!cloth.face_panel.empty() && cloth.face_panel.size() != cloth.faces.size())
        throw std::invalid_argument("face_panel must be empty or hold one panel for each face");
    if (!cloth.face_colours.empty() && cloth.face_colours.size() != cloth.faces.size())
        throw std::invalid_argument("face_colours must be empty or hold one colour for each face");
    for (const int face : cloth.highlighted_faces)
        if (face < 0 || face >= int(cloth.faces.size()))
            throw std::invalid_argument("highlighted face " + std::to_string(face) + " does not exist");
}

Vec3 middle(const std::vector<Vec3>& positions)
{
    Eigen::AlignedBox3d box;
    for (const Vec3& position : positions)
        if (position.allFinite()) box.extend(position);
    return box.isEmpty() ? Vec3::Zero() : Vec3(box.center());
}

// Returns colours of slightly different hue; multiples of the golden ratio give neighbouring panels distinct ones.
Vec3f panel_colour(int panel)
{
    static const Vec3f blue(0.070f, 0.190f, 0.305f), green(0.085f, 0.235f, 0.310f);
    const float golden = 0.618034f * float(panel), share = golden - std::floor(golden);
    return blue + share * (green - blue);
}

std::vector<Vec3f> face_colours(const PictureCloth& cloth, const DrawnMesh& mesh)
{
    std::vector<char> highlighted(cloth.faces.size());
    for (const int face : cloth.highlighted_faces) highlighted[std::size_t(face)] = 1;
    std::vector<Vec3f> colours;
    for (const int source : mesh.source_face) {
        const int panel = cloth.face_panel.empty() ? 0 : cloth.face_panel[std::size_t(source)];
        if (highlighted[std::size_t(source)])
            colours.push_back(warning_colour);
        else if (!cloth.face_colours.empty())
            colours.push_back(Vec3f(cloth.face_colours[std::size_t(source)].data()));
        else
            colours.push_back(panel_colour(panel));
    }
    return colours;
}

PictureScene make_scene(const PictureCloth& cloth, const std::vector<TriangleMesh>& bodies, bool has_ground)
{
    const Vec3 origin = middle(cloth.positions);
    PictureScene scene;
    scene.meshes.push_back(make_drawn_mesh(cloth.positions, cloth.faces, origin));
    for (const TriangleMesh& body : bodies) scene.meshes.push_back(make_drawn_mesh(body.vertices, body.faces, origin));
    scene.cloth.face_colours = face_colours(cloth, scene.meshes.front());

    float lowest = std::numeric_limits<float>::infinity();
    for (const DrawnMesh& mesh : scene.meshes)
        for (const Face& face : mesh.faces)
            for (const int vertex : face) lowest = std::min(lowest, mesh.positions[std::size_t(vertex)].z());
    scene.has_ground = has_ground && std::isfinite(lowest);
    scene.ground_height = lowest;
    return scene;
}

}  // namespace

Image render_picture(const PictureCloth& cloth, const std::vector<TriangleMesh>& bodies, const PictureOptions& options)
{
    check(cloth, options);
    PictureScene scene = make_scene(cloth, bodies, options.ground);
    const std::vector<Vec3f> points = framed_points(scene.meshes);
    for (const Vec3f& point : points) scene.radius = std::max(scene.radius, point.norm());
    const auto directions = view_directions(options.views, !cloth.seam_edges.empty(), points);
    float aspect = flattest;
    for (const ViewDirection& direction : directions) aspect = std::max(aspect, outline_aspect(points, direction));
    aspect = std::min(aspect, tallest);

    const int view_width = options.width / 2;
    const int height = int(std::lround(aspect * float(view_width)));
    std::array<Camera, 2> cameras;
    for (std::size_t view = 0; view < 2; ++view) cameras[view] = frame_points(points, directions[view], aspect, margin);

    const DrawnMesh& mesh = scene.meshes.front();
    ClothLook& look = scene.cloth;
    look.line_width = 2.2f * cameras[0].pixel_size(view_width);
    look.seams = LineMarks(mesh, cloth.seam_edges, line_reach(look.line_width));
    look.hems = LineMarks(mesh, boundary_edges(mesh), line_reach(look.line_width));

    std::vector<const DrawnMesh*> meshes;
    for (const DrawnMesh& drawn : scene.meshes) meshes.push_back(&drawn);
    const SceneTracer tracer(meshes);
    Image image = make_image(options.width, height);
    for (int view = 0; view < 2; ++view) {
        const int first_column = view * view_width;
        const int width = view == 0 ? view_width : options.width - view_width;
        if (!draw_view(scene, tracer, cameras[std::size_t(view)], options.samples_per_axis, options.stop, first_column,
                       width, image))
            return {};
    }
    return image;
}

}  // namespace selvage
