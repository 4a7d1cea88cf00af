#pragma once
#include <array>
#include <functional>
#include <vector>

#include "host/render/camera.hpp"
#include "io/geometry.hpp"
#include "io/image.hpp"

namespace selvage {

/// The cloth as it is drawn.
struct PictureCloth {
    std::vector<Vec3> positions;  ///< [m], z up
    std::vector<Face> faces;
    std::vector<int> face_panel;  ///< Panel of each face, for its colour; empty for one panel.
    /// Linear reflectance of each face, red, green and blue; empty: from its panel.
    std::vector<std::array<float, 3>> face_colours = {};
    std::vector<std::array<int, 2>> seam_edges;  ///< Vertex pairs drawn as stitching.
    std::vector<int> highlighted_faces;          ///< Drawn in a warning colour.
};

struct PictureOptions {
    int width = 1600;          ///< Of the whole picture [pixels]; its height follows from the subject.
    int samples_per_axis = 3;  ///< Square root of the camera rays per pixel.
    bool ground = true;        ///< Lets the subject cast a shadow on a ground below it.
    PictureViews views = PictureViews::automatic;
    std::function<bool()> stop = {};  ///< Asked from several threads; true breaks the picture off.
};

/// Draws cloth and bodies with smooth shading and soft light, two views side by side. The views show the cloth and the
/// parts of the bodies close to it. The picture depends on nothing but the arguments: two calls give the same pixels.
/// Faces with corners that are not finite are left out. A picture that `stop` has broken off has no pixels.
/// @throws std::invalid_argument if an index is out of range, width < 16 or samples_per_axis < 1.
/// @throws std::runtime_error if Embree fails.
Image render_picture(const PictureCloth& cloth, const std::vector<TriangleMesh>& bodies,
                     const PictureOptions& options = {});

}  // namespace selvage
