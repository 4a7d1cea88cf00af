#pragma once
#include <array>
#include <string>
#include <vector>

#include "io/finding.hpp"
#include "io/geometry.hpp"

namespace selvage {

/// One flat piece of the cloth: a run of vertices and faces.
struct ClothPanel {
    std::string name;
    std::string fabric;  ///< Key into Scene::fabrics.
    int first_vertex = 0, vertex_count = 0;
    int first_face = 0, face_count = 0;
    double rest_area = 0;      ///< Area of the triangulated outline [m^2].
    double rest_boundary = 0;  ///< Length of the boundary polygon [m].
    bool reversed = false;     ///< Its outside is the side from which the faces look clockwise.
    /// Index of a vertex in the mesh file, from 0, and one of the vertices it has become, from 0 in the panel; sorted.
    /// A point at a seam is several vertices, and several of the file may be joined to one. Empty: made here.
    std::vector<std::array<int, 2>> file_numbers;
};

/// The sampled vertices of one outline edge, from its start to its end.
struct OutlineSamples {
    int panel = 0, edge = 0;
    std::vector<int> vertices;       ///< Cloth vertex indices, both corners included.
    std::vector<double> parameters;  ///< Arc-length fraction in [0, 1], same length as `vertices`.
    double length = 0;               ///< Arc length of the exact curve [m].
};

/// Two outline edges sewn together; its pairs are a run of Cloth::seam_pairs.
struct Seam {
    int side_a = 0, side_b = 0;  ///< Indices into Cloth::outline.
    int first_pair = 0, pair_count = 0;
    double length_a = 0, length_b = 0;  ///< [m]; unequal for a gathered seam.
    InputPlace place = {};              ///< Of the stitch in the pattern.
};

/// A band of elastic that is sewn, stretched, along vertices of an outline.
struct Elastic {
    std::vector<int> vertices;  ///< One after the other.
    double shrink = 1;          ///< Its length at rest over that of the flat cloth along it [1].
    double stiffness = 0;       ///< Tension at twice its length [N].
};

/// A prescribed motion of pinned vertices: a rotation about an axis and a translation, both at constant speed from
/// `start` to `end` [s].
struct PinMotion {
    std::vector<int> vertices;
    double start = 0, end = 1;
    Vec3 velocity = Vec3::Zero();  ///< [m/s]
    Vec3 axis = Vec3::UnitZ();     ///< Unit.
    Vec3 point = Vec3::Zero();     ///< A point on the axis [m].
    double turns = 0;              ///< From start to end, counter-clockwise.
};

/// The flat, unsewn cloth and its start positions. Faces of different panels share no vertices; seams join pairs
/// of vertices later.
struct Cloth {
    std::vector<Vec2> panel_coordinates;  ///< Rest position in the panel's plane: (weft, warp) [m].
    std::vector<Vec3> positions;          ///< Start position in the scene [m].
    std::vector<Face> faces;              ///< Counter-clockwise in panel coordinates.
    std::vector<ClothPanel> panels;
    std::vector<OutlineSamples> outline;  ///< Every outline edge of every panel (garments).
    std::vector<Seam> seams;
    std::vector<std::array<int, 2>> seam_pairs;  ///< Vertices that are sewn to each other.
    std::vector<Elastic> elastics;
    std::vector<int> pinned;             ///< Vertices with prescribed positions, sorted.
    std::vector<PinMotion> pin_motions;  ///< In the order in which they are applied.
    std::vector<Finding> findings;       ///< Unusual input that could be used.
};

/// Returns the faces of a cloth, counter-clockwise as seen from its outside, in the order of Cloth::faces.
std::vector<Face> outward_faces(const Cloth& cloth);

/// True if the vertices of every seam start at one place, as in a sheet that was read sewn; also without seams.
bool seams_are_closed(const Cloth& cloth);

/// Appends the panels, seams and pins of another cloth, with its indices shifted.
void append_cloth(Cloth& to, const Cloth& other);

/// Returns the mean length of the edges of all faces at rest [m]; 0.01 without faces.
double typical_edge(const Cloth& cloth);

/// Returns the least height of a face at rest [m].
double least_height(const Cloth& cloth, int face);

/// A prolongation: linear interpolation from the vertices of a coarse cloth to those of a fine one, in compressed rows.
struct Prolongation {
    std::vector<int> offset;     ///< Fine vertex count + 1.
    std::vector<int> column;     ///< Coarse vertex.
    std::vector<double> weight;  ///< Non-negative; each row sums to 1.
};

}  // namespace selvage
