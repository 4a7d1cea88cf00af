#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "host/body/anatomy.hpp"
#include "io/errors.hpp"
#include "io/geometry.hpp"

namespace selvage {

/// A point of a body by its name, such as `left_shoulder`; sides are those of the wearer.
struct Landmark {
    std::string name;
    Vec3 position = Vec3::Zero();  ///< In the axes of the mesh [m].
};

/// A girth or a length.
struct BodyMeasure {
    std::string name;
    double value = 0;                      ///< [m]; of limbs the mean of both sides.
    std::string where;                     ///< How it was measured.
    std::vector<std::vector<Vec3>> lines;  ///< What it was measured along, in the axes of the mesh [m].
    bool closed = false;                   ///< The lines run around the body.
};

/// A section of a limb.
struct LimbSection {
    Vec3 middle = Vec3::Zero();  ///< In the axes of the mesh [m].
    double girth = 0;            ///< Of a tape around it [m].
};

/// The centre line of a limb, from the trunk to its tip: arms from the armpit to the palm, in sections across them;
/// legs from below the crotch to the foot, in level sections.
struct LimbLine {
    std::string name;  ///< `left_arm`, `right_arm`, `left_leg` or `right_leg`.
    std::vector<LimbSection> sections;
};

/// What measure_body() finds. What the shape does not show is missing: nothing is estimated.
struct BodyMeasures {
    double height = 0;  ///< [m]
    BodyFrame frame;    ///< Which way the body faces.
    std::vector<BodyMeasure> girths, lengths;
    std::vector<Landmark> landmarks;
    std::vector<LimbLine> limbs;
    std::vector<BodyRegion> regions;   ///< Of each vertex of the mesh.
    std::vector<std::string> missing;  ///< Names of measures that the shape does not show, or whose sides disagree.
    double area_share = 1;             ///< Of the measured piece in all of the mesh's area.
    double open_edges = 0;             ///< Length of the edges of holes [m].

    const BodyMeasure* girth(std::string_view name) const;
    const BodyMeasure* length(std::string_view name) const;
    const Landmark* landmark(std::string_view name) const;
    const LimbLine* limb(std::string_view name) const;
};

/// Finds parts, landmarks and measures of a body from its shape alone, in any pose in which it stands with arms and
/// legs apart. Loose pieces beside the largest one are not measured; holes are spanned.
/// @param mesh   z up, faces outward or not [m]
/// @param place  the body in the user's input, for messages
/// @throws InputError that says what was not found if the mesh is no such body
BodyMeasures measure_body(const TriangleMesh& mesh, const InputPlace& place);

}  // namespace selvage
