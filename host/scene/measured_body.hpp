#pragma once
#include <string>
#include <vector>

#include "io/choices.hpp"
#include "io/geometry.hpp"

namespace selvage {

/// A body to be measured, as the user names it.
struct BodySource {
    std::string source;                  ///< OBJ file, scene file or `builtin:NAME` of a scene; or `builtin:mannequin`.
    std::vector<std::string> overrides;  ///< `table.key=value`, of a scene.
    LengthUnit unit = LengthUnit::m;     ///< Of an OBJ file.
    Axis up_axis = Axis::z;              ///< Of an OBJ file.
    double scale = 1;                    ///< Of an OBJ file.
};

/// Returns the mesh of a body [m], z up: all vertices of an OBJ file, or the first body of a scene as it starts.
/// @throws InputError for files that cannot be read, scenes without a body, a size that no person has, a lying body
TriangleMesh load_measured_body(const BodySource& body);

}  // namespace selvage
