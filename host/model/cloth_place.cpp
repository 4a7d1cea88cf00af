#include "host/model/cloth_place.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace selvage {
namespace {

// Panels are runs of vertices and faces in ascending order: the last that begins at or before an item has it.
const ClothPanel& panel_of(const Cloth& cloth, int item, int ClothPanel::*first)
{
    const auto next = std::find_if(cloth.panels.begin() + 1, cloth.panels.end(),
                                   [&](const ClothPanel& panel) { return panel.*first > item; });
    return *(next - 1);
}

std::string name_item(std::string_view kind, const ClothPanel& panel, int item, int first)
{
    if (first == 0) return fmt::format("{} {} of `{}`", kind, item, panel.name);
    return fmt::format("{} {} of `{}` ({} of all)", kind, item - first, panel.name, item);
}

}  // namespace

const ClothPanel& panel_of_vertex(const Cloth& cloth, int vertex)
{
    return panel_of(cloth, vertex, &ClothPanel::first_vertex);
}

const ClothPanel& panel_of_face(const Cloth& cloth, int face) { return panel_of(cloth, face, &ClothPanel::first_face); }

std::string describe_position(const Vec3& position)
{
    const auto rounded = [](double x) { return std::round(x * 1e4) / 1e4 + 0.0; };  // and no -0
    return fmt::format("({:.4f}, {:.4f}, {:.4f}) m", rounded(position.x()), rounded(position.y()),
                       rounded(position.z()));
}

std::string describe_vertex(const Cloth& cloth, int vertex, const Vec3& position)
{
    const ClothPanel& panel = panel_of_vertex(cloth, vertex);
    return name_item("vertex", panel, vertex, panel.first_vertex) + " at " + describe_position(position);
}

std::string describe_face(const Cloth& cloth, int face, const std::vector<Vec3>& positions)
{
    const ClothPanel& panel = panel_of_face(cloth, face);
    const Face& f = cloth.faces[face];
    return name_item("triangle", panel, face, panel.first_face) + " at " +
           describe_position((positions[f[0]] + positions[f[1]] + positions[f[2]]) / 3);
}

}  // namespace selvage
