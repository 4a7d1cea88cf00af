#include "host/body/body_picture.hpp"

#include <cmath>

#include <Eigen/Geometry>

#include "host/mesh/body_tessellation.hpp"
#include "host/render/picture.hpp"

namespace selvage {
namespace {

constexpr double line_radius = 0.0022, ball_radius = 0.0075;  // [m], for a body 1.7 m high; chosen by eye
constexpr int sides = 6;                                      // of the prisms that lines are drawn as

using Colour = std::array<float, 3>;  // linear reflectance

constexpr Colour line_colour{0.02f, 0.02f, 0.02f}, ball_colour{0.80f, 0.05f, 0.03f};

Colour colour_of(BodyRegion region)
{
    switch (region) {
        case BodyRegion::torso:
            return {0.45f, 0.40f, 0.33f};
        case BodyRegion::neck:
            return {0.50f, 0.30f, 0.10f};
        case BodyRegion::head:
            return {0.55f, 0.45f, 0.15f};
        case BodyRegion::left_arm:
            return {0.10f, 0.32f, 0.50f};
        case BodyRegion::right_arm:
            return {0.12f, 0.45f, 0.25f};
        case BodyRegion::left_hand:
            return {0.25f, 0.52f, 0.68f};
        case BodyRegion::right_hand:
            return {0.35f, 0.65f, 0.40f};
        case BodyRegion::left_leg:
            return {0.22f, 0.18f, 0.50f};
        case BodyRegion::right_leg:
            return {0.45f, 0.15f, 0.32f};
        case BodyRegion::left_foot:
            return {0.42f, 0.38f, 0.68f};
        case BodyRegion::right_foot:
            return {0.65f, 0.35f, 0.50f};
        case BodyRegion::loose:
            break;
    }
    return {0.30f, 0.30f, 0.30f};
}

void add_mesh(PictureCloth& picture, const std::vector<Vec3>& vertices, const std::vector<Face>& faces,
              const Colour& colour)
{
    const int first = int(picture.positions.size());
    picture.positions.insert(picture.positions.end(), vertices.begin(), vertices.end());
    for (const Face& face : faces) {
        picture.faces.push_back({face[0] + first, face[1] + first, face[2] + first});
        picture.face_colours.push_back(colour);
    }
}

// A prism around a piece of a line.
void add_rod(PictureCloth& picture, const Vec3& from, const Vec3& to, double radius)
{
    if (!((to - from).norm() > 1e-9)) return;
    const Vec3 axis = (to - from).normalized(), u = axis.unitOrthogonal(), v = axis.cross(u);
    std::vector<Vec3> vertices;
    std::vector<Face> faces;
    for (int k = 0; k < sides; ++k) {
        const double angle = 2 * M_PI * k / sides;
        const Vec3 out = radius * (std::cos(angle) * u + std::sin(angle) * v);
        vertices.push_back(from + out);
        vertices.push_back(to + out);
        const int a = 2 * k, b = 2 * ((k + 1) % sides);
        faces.push_back({a, b, b + 1});
        faces.push_back({a, b + 1, a + 1});
    }
    add_mesh(picture, vertices, faces, line_colour);
}

}  // namespace

Image draw_measures(const TriangleMesh& mesh, const BodyMeasures& measures, int width)
{
    PictureCloth picture;
    const double size = measures.height / 1.7;
    for (const Vec3& x : mesh.vertices) picture.positions.push_back(measures.frame.to_body(x));
    picture.faces = mesh.faces;
    for (const Face& face : mesh.faces) {
        // The part of two corners; a face between three parts takes the first.
        const BodyRegion a = measures.regions[face[0]], b = measures.regions[face[1]], c = measures.regions[face[2]];
        picture.face_colours.push_back(colour_of(b == c ? b : a));
    }
    for (const auto* list : {&measures.girths, &measures.lengths})
        for (const BodyMeasure& measure : *list)
            for (const std::vector<Vec3>& line : measure.lines)
                for (std::size_t k = measure.closed ? 0 : 1; k < line.size(); ++k)
                    add_rod(picture, measures.frame.to_body(line[k == 0 ? line.size() - 1 : k - 1]),
                            measures.frame.to_body(line[k]), line_radius * size);
    for (const Landmark& landmark : measures.landmarks) {
        const TriangleMesh ball = sphere_mesh(measures.frame.to_body(landmark.position), ball_radius * size, 1);
        add_mesh(picture, ball.vertices, ball.faces, ball_colour);
    }
    PictureOptions options;
    options.width = width;
    options.views = PictureViews::front_and_side;
    return render_picture(picture, {}, options);
}

}  // namespace selvage
