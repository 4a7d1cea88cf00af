#include "host/mesh/renumber.hpp"

#include <algorithm>

#include "host/mesh/grid_point.hpp"

namespace selvage {

std::vector<int> renumber_for_locality(std::vector<Vec2>& coordinates, std::vector<Face>& faces)
{
    const GridMap map(coordinates);
    std::vector<GridPoint> grid;
    grid.reserve(coordinates.size());
    for (const Vec2& point : coordinates) grid.push_back(map.to_grid(point));
    const std::vector<int> order = hilbert_order(grid);
    std::vector<int> renumbered(order.size());
    std::vector<Vec2> moved(order.size());
    for (int vertex = 0; vertex < int(order.size()); ++vertex) {
        renumbered[order[vertex]] = vertex;
        moved[vertex] = coordinates[order[vertex]];
    }
    coordinates = std::move(moved);
    for (Face& face : faces) {
        for (int& vertex : face) vertex = renumbered[vertex];
        std::rotate(face.begin(), std::min_element(face.begin(), face.end()), face.end());
    }
    std::sort(faces.begin(), faces.end());
    return renumbered;
}

}  // namespace selvage
