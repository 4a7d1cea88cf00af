#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <limits>

#include "host/render/camera.hpp"
#include "host/render/line_marks.hpp"
#include "host/render/picture.hpp"
#include "host/render/sampling.hpp"
#include "host/run/render_run.hpp"
#include "io/errors.hpp"
#include "validation/unit/catch.hpp"

using namespace selvage;

namespace {

// An upright square sheet of 1 m in the x-z plane, seen from the front without folds or shade.
PictureCloth upright_sheet(int cells)
{
    PictureCloth cloth;
    for (int row = 0; row <= cells; ++row)
        for (int column = 0; column <= cells; ++column)
            cloth.positions.emplace_back(double(column) / cells, 0, double(row) / cells);
    for (int row = 0; row < cells; ++row)
        for (int column = 0; column < cells; ++column) {
            const int a = row * (cells + 1) + column, b = a + 1, c = b + cells + 1, d = c - 1;
            cloth.faces.push_back({a, b, c});
            cloth.faces.push_back({a, c, d});
        }
    return cloth;
}

TriangleMesh tetrahedron()
{
    return {
        {{0.2, 0.5, 0}, {0.8, 0.5, 0}, {0.5, 1, 0}, {0.5, 0.7, 0.6}}, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}, {}};
}

PictureOptions small_front_view()
{
    PictureOptions options;
    options.width = 200;
    options.samples_per_axis = 2;
    options.views = PictureViews::front_and_back;
    return options;
}

template <class Predicate>
int count_pixels(const Image& image, const Predicate& predicate)
{
    return int(std::count_if(image.pixels.begin(), image.pixels.end(), predicate));
}

int brightness(const Rgb& rgb) { return rgb[0] + rgb[1] + rgb[2]; }
bool is_warning(const Rgb& rgb) { return rgb[0] > 2 * rgb[1] && rgb[0] > 2 * rgb[2] && rgb[0] > 80; }
bool is_fabric(const Rgb& rgb) { return rgb[2] > rgb[0] + 25; }

}  // namespace

TEST_CASE("a picture has the requested width and shows cloth before a pale backdrop in both views", "[render]")
{
    const Image image = render_picture(upright_sheet(8), {}, small_front_view());
    REQUIRE(image.width == 200);
    REQUIRE(image.height >= 60);
    REQUIRE(image.pixels.size() == std::size_t(image.width * image.height));
    for (const int middle : {50, 150}) CHECK(is_fabric(image.at(middle, image.height / 2)));
    for (const int corner : {1, 99, 100, 198}) {
        CHECK_FALSE(is_fabric(image.at(corner, 1)));
        CHECK(brightness(image.at(corner, 1)) > 600);
    }
}

TEST_CASE("two renderings of one scene are equal bit for bit", "[render]")
{
    const PictureCloth cloth = upright_sheet(8);
    const Image first = render_picture(cloth, {tetrahedron()}, small_front_view());
    const Image second = render_picture(cloth, {tetrahedron()}, small_front_view());
    CHECK(first.pixels == second.pixels);
}

TEST_CASE("highlighted faces are drawn in the warning colour and others are not", "[render]")
{
    PictureCloth cloth = upright_sheet(8);
    CHECK(count_pixels(render_picture(cloth, {}, small_front_view()), is_warning) == 0);
    cloth.highlighted_faces = {0, 1, 2, 3};
    CHECK(count_pixels(render_picture(cloth, {}, small_front_view()), is_warning) > 50);
}

TEST_CASE("a seam darkens the pixels along it and leaves the rest of the cloth alone", "[render]")
{
    PictureCloth cloth = upright_sheet(8);
    const Image plain = render_picture(cloth, {}, small_front_view());
    for (int row = 0; row < 8; ++row) cloth.seam_edges.push_back({row * 9 + 4, (row + 1) * 9 + 4});
    const Image sewn = render_picture(cloth, {}, small_front_view());
    const int row = plain.height / 2;
    CHECK(brightness(sewn.at(50, row)) < 0.8 * brightness(plain.at(50, row)));
    CHECK(std::abs(brightness(sewn.at(30, row)) - brightness(plain.at(30, row))) <= 3);
}

TEST_CASE("a run's seams are the edges whose ends lie in two places of the flat cloth, darts among them", "[render]")
{
    // A strip of four triangles: a panel of two, the second one sewn to it by a dart, and one of two by a seam.
    TrajectoryLayout layout;
    layout.point_count = 6;
    layout.triangles = {{0, 1, 2}, {1, 3, 2}, {2, 3, 4}, {3, 5, 4}};
    layout.panel = {0, 0, 0, 0, 1, 1};  // points that panels share belong to the first one
    layout.triangle_panel = {0, 0, 1, 1};
    layout.rest_corners = {{Vec2(0, 0), Vec2(1, 0), Vec2(0, 1)},
                           {Vec2(1.1, 0), Vec2(1.1, 1), Vec2(0.1, 1)},
                           {Vec2(0, 0), Vec2(1, 0), Vec2(0, 1)},
                           {Vec2(1, 0), Vec2(1, 1), Vec2(0, 1)}};
    using Edges = std::vector<std::array<int, 2>>;
    CHECK(seam_edges(layout) == Edges{{1, 2}, {2, 3}});
    layout.rest_corners.clear();
    CHECK(seam_edges(layout) == Edges{{2, 3}});
}

TEST_CASE("a body shows where the cloth does not cover it", "[render]")
{
    PictureCloth nothing;
    const Image empty = render_picture(nothing, {}, small_front_view());
    const Image body = render_picture(nothing, {tetrahedron()}, small_front_view());
    CHECK(brightness(body.at(50, body.height / 2)) < brightness(empty.at(50, empty.height / 2)) - 40);
}

TEST_CASE("the ground shows a shadow only if the options say so", "[render]")
{
    PictureOptions options = small_front_view();
    options.views = PictureViews::three_quarters;
    const auto dim = [](const Rgb& rgb) { return brightness(rgb) < 540 && !is_fabric(rgb); };
    PictureCloth flat = upright_sheet(4);
    for (Vec3& position : flat.positions) position = {position.x(), position.z(), 0.3};
    TriangleMesh mark;
    mark.vertices = {{0.5, 0.5, 0}, {0.51, 0.5, 0}, {0.5, 0.51, 0}};
    mark.faces = {{0, 1, 2}};
    const int shaded = count_pixels(render_picture(flat, {mark}, options), dim);
    options.ground = false;
    CHECK(shaded > count_pixels(render_picture(flat, {mark}, options), dim) + 100);
}

TEST_CASE("faces with corners that are not finite are left out of the picture", "[render]")
{
    PictureCloth cloth = upright_sheet(8);
    cloth.positions[0].x() = std::numeric_limits<double>::quiet_NaN();
    cloth.positions[80].z() = std::numeric_limits<double>::infinity();
    const Image image = render_picture(cloth, {}, small_front_view());
    CHECK(is_fabric(image.at(50, image.height / 2)));

    for (Vec3& position : cloth.positions) position.setConstant(std::numeric_limits<double>::quiet_NaN());
    CHECK(count_pixels(render_picture(cloth, {}, small_front_view()), is_fabric) == 0);
}

TEST_CASE("indices out of range are refused", "[render]")
{
    PictureCloth cloth = upright_sheet(2);
    cloth.seam_edges = {{0, 99}};
    CHECK_THROWS_AS(render_picture(cloth, {}, small_front_view()), std::invalid_argument);
    cloth.seam_edges.clear();
    cloth.highlighted_faces = {8};
    CHECK_THROWS_AS(render_picture(cloth, {}, small_front_view()), std::invalid_argument);
    cloth.highlighted_faces.clear();
    cloth.faces.push_back({0, 1, -1});
    CHECK_THROWS_AS(render_picture(cloth, {}, small_front_view()), std::invalid_argument);
}

TEST_CASE("a framed point is never outside the picture, and one touches the margin", "[render]")
{
    const std::vector<Vec3f> points{{0, 0, 0}, {0.4f, -0.2f, 1.7f}, {-0.5f, 0.3f, 0.9f}, {0.1f, 0.8f, 0.2f}};
    const float margin = 0.05f;
    for (const float aspect : {0.6f, 1.3f})
        for (const float azimuth : {0.f, 0.6f, 3.1f}) {
            const Camera camera = frame_points(points, {azimuth, 0.3f}, aspect, margin);
            float farthest = 0;
            for (const Vec3f& point : points) {
                const Vec3f seen = point - camera.origin;
                const float depth = seen.dot(camera.forward);
                REQUIRE(depth > 0);
                farthest = std::max({farthest, std::abs(seen.dot(camera.right)) / depth / camera.half_width,
                                     std::abs(seen.dot(camera.up)) / depth / camera.half_height});
            }
            CHECK(farthest <= 1 - 2 * margin + 1e-4f);
            CHECK(farthest > 1 - 2 * margin - 0.02f);
        }
}

TEST_CASE("smooth cloth shares normals across faces and a sharp fold keeps its own", "[render]")
{
    const std::vector<Face> faces{{0, 1, 2}, {1, 0, 3}};
    for (const double rise : {0.2, 20.0}) {
        const std::vector<Vec3> positions{{0, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {1, 0, rise}};
        const DrawnMesh mesh = make_drawn_mesh(positions, faces, Vec3::Zero());
        const float turn = mesh.normals[0][0].dot(mesh.face_normals[0]);
        if (rise < 1)
            CHECK(mesh.normals[0][0].isApprox(mesh.normals[1][1]));
        else
            CHECK(turn == Approx(1).margin(1e-6));
    }
}

TEST_CASE("marked lines give exact distances within their reach, and hems are the edges of only one face", "[render]")
{
    const PictureCloth cloth = upright_sheet(10);
    const DrawnMesh mesh = make_drawn_mesh(cloth.positions, cloth.faces, Vec3::Zero());
    CHECK(boundary_edges(mesh).size() == 40);
    const LineMarks hems(mesh, boundary_edges(mesh), 0.25f);
    for (int face = 0; face < int(mesh.faces.size()); ++face) {
        const Vec3f point = mesh.point(face, 0.3f, 0.3f);
        const float expected = std::min({point.x(), 1 - point.x(), point.z(), 1 - point.z()});
        if (expected < 0.25f)
            CHECK(hems.distance(face, point) == Approx(expected).margin(1e-6));
        else
            CHECK(hems.distance(face, point) >= 0.25f);
    }
}

TEST_CASE("interleaved samples cover the disc evenly in every block of pixels", "[render]")
{
    const InterleavedSamples samples(16);
    for (const int corner : {0, 3}) {
        double sum_x = 0, sum_y = 0, sum_squared = 0;
        for (int row = 0; row < 4; ++row)
            for (int column = 0; column < 4; ++column)
                for (int sample = 0; sample < 16; ++sample) {
                    const DiscPoint point = samples.at(corner + column, corner + row, sample);
                    sum_x += point.x;
                    sum_y += point.y;
                    sum_squared += point.x * point.x + point.y * point.y;
                }
        CHECK(sum_x / 256 == Approx(0).margin(0.01));
        CHECK(sum_y / 256 == Approx(0).margin(0.01));
        CHECK(sum_squared / 256 == Approx(0.5).margin(0.005));
    }
}

TEST_CASE("a written picture is a PNG file, and one that cannot be written is refused", "[image]")
{
    const std::string file = (std::filesystem::temp_directory_path() / "selvage_test_render.png").string();
    write_png(file, make_image(7, 5, {10, 20, 30}));
    std::array<unsigned char, 24> head{};
    std::FILE* stream = std::fopen(file.c_str(), "rb");
    REQUIRE(stream);
    REQUIRE(std::fread(head.data(), 1, head.size(), stream) == head.size());
    std::fclose(stream);
    std::filesystem::remove(file);
    CHECK(head[0] == 0x89);
    CHECK(head[1] == 'P');
    CHECK(head[19] == 7);
    CHECK(head[23] == 5);
    CHECK_THROWS_AS(write_png("/nowhere/at/all.png", make_image(2, 2)), InputError);
    CHECK_THROWS_AS(write_png(file, Image{}), InputError);
}

TEST_CASE("outlines are smoothed on both sides of the cloth", "[render]")
{
    PictureCloth cloth = upright_sheet(1);
    for (Vec3& position : cloth.positions) position.x() += 0.1 * position.z();
    PictureOptions options = small_front_view();
    options.samples_per_axis = 4;
    const Image image = render_picture(cloth, {}, options);
    int partly_covered[2] = {0, 0};
    for (int row = 20; row < image.height - 20; ++row)
        for (int column = 1; column < 99; ++column) {
            const int here = brightness(image.at(column, row));
            const int left = brightness(image.at(column - 1, row)), right = brightness(image.at(column + 1, row));
            if (std::abs(left - right) > 100 && here > std::min(left, right) + 40 && here < std::max(left, right) - 40)
                ++partly_covered[column > 50];
        }
    CHECK(partly_covered[0] > 20);
    CHECK(partly_covered[1] > 20);
}
