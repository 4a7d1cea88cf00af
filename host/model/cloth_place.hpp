#pragma once
#include <string>

#include "host/model/cloth.hpp"

namespace selvage {

/// Returns the panel of a vertex or of a face; a sheet is a panel too.
const ClothPanel& panel_of_vertex(const Cloth& cloth, int vertex);
const ClothPanel& panel_of_face(const Cloth& cloth, int face);

/// Names a vertex for messages: its panel, its number there and in the whole cloth, and where it is.
/// @param position  [m]
std::string describe_vertex(const Cloth& cloth, int vertex, const Vec3& position);

/// The same of a face. @param positions  per cloth vertex [m]
std::string describe_face(const Cloth& cloth, int face, const std::vector<Vec3>& positions);

/// Returns a place as `(x, y, z) m`, to a tenth of a millimetre.
std::string describe_position(const Vec3& position);

}  // namespace selvage
