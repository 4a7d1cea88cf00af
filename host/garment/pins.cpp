#include "host/garment/pins.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <span>

#include "io/scene/pin_checks.hpp"

namespace selvage {
namespace {

int nearest_vertex(std::span<const Vec2> points, const Vec2& place)
{
    const auto distance = [&](const Vec2& point) { return (point - place).squaredNorm(); };
    return int(std::min_element(points.begin(), points.end(),
                                [&](const Vec2& a, const Vec2& b) { return distance(a) < distance(b); }) -
               points.begin());
}

// The vertices nearest to the corners of the bounding box: lower left, lower right, upper left, upper right.
std::array<int, 4> corner_vertices(std::span<const Vec2> points, const Vec2& low, const Vec2& high)
{
    return {nearest_vertex(points, low), nearest_vertex(points, Vec2(high.x(), low.y())),
            nearest_vertex(points, Vec2(low.x(), high.y())), nearest_vertex(points, high)};
}

// These vertices of a panel and all that share a face with one of them.
std::set<int> with_their_faces(const std::set<int>& vertices, const Cloth& cloth, const ClothPanel& panel)
{
    std::set<int> all = vertices;
    for (int f = panel.first_face; f < panel.first_face + panel.face_count; ++f) {
        Face face = cloth.faces[f];
        for (int& vertex : face) vertex -= panel.first_vertex;
        if (std::any_of(face.begin(), face.end(), [&](int vertex) { return vertices.count(vertex) > 0; }))
            all.insert(face.begin(), face.end());
    }
    return all;
}

// The vertices of a panel that belong to a group, counted from 0 in the panel.
std::set<int> group_vertices(PinGroup group, const Cloth& cloth, const ClothPanel& panel)
{
    const auto points = std::span(cloth.panel_coordinates).subspan(panel.first_vertex, panel.vertex_count);
    Vec2 low = points.front(), high = points.front();
    for (const Vec2& point : points) {
        low = low.cwiseMin(point);
        high = high.cwiseMax(point);
    }
    const double tolerance = 1e-6 * (high - low).maxCoeff();
    const auto edge = [&](int axis, double at) {
        std::set<int> held;
        for (int vertex = 0; vertex < int(points.size()); ++vertex)
            if (std::abs(points[vertex][axis] - at) <= tolerance) held.insert(vertex);
        return held;
    };
    const std::array<int, 4> corners = corner_vertices(points, low, high);
    switch (group) {
        case PinGroup::none:
            return {};
        case PinGroup::corners:
            return {corners.begin(), corners.end()};
        case PinGroup::top_corners:
            return {corners[2], corners[3]};
        case PinGroup::right_corners:
            return {corners[1], corners[3]};
        case PinGroup::top_edge:
            return edge(1, high.y());
        case PinGroup::left_edge:
            return edge(0, low.x());
        case PinGroup::right_edge:
            return edge(0, high.x());
        case PinGroup::center:
            return {nearest_vertex(points, 0.5 * (low + high))};
        case PinGroup::two_rows:
            return with_their_faces(edge(0, low.x()), cloth, panel);
    }
    return {};
}

int last_number(const ClothPanel& panel)
{
    return panel.file_numbers.empty() ? panel.vertex_count - 1 : panel.file_numbers.back()[0];
}

// The vertices of a panel with a number: in its mesh file, where a vertex at a seam stands for several.
std::set<int> vertices_of_number(const ClothPanel& panel, int number)
{
    std::set<int> vertices;
    if (panel.file_numbers.empty() && number < panel.vertex_count) vertices.insert(number);
    for (auto at = std::ranges::lower_bound(panel.file_numbers, std::array{number, -1});
         at != panel.file_numbers.end() && (*at)[0] == number; ++at)
        vertices.insert((*at)[1]);
    return vertices;
}

std::set<int> listed_vertices(const std::string& list, const ClothPanel& panel, const InputPlace& place)
{
    std::set<int> vertices;
    for (const int number : listed_indices(list, place)) {
        const std::set<int> named = vertices_of_number(panel, number);
        if (named.empty())
            throw InputError(place, "`" + std::to_string(number) + "`",
                             "indices from 0 to " + std::to_string(last_number(panel)) + " of " + panel.name +
                                 (panel.file_numbers.empty() ? "" : ", of vertices that a face uses") +
                                 ", separated by commas");
        vertices.insert(named.begin(), named.end());
    }
    return vertices;
}

// Panels of garments have outlines, sheets have none.
bool is_sheet(const Cloth& cloth, int panel)
{
    return std::none_of(cloth.outline.begin(), cloth.outline.end(),
                        [&](const OutlineSamples& samples) { return samples.panel == panel; });
}

// The edges of a panel's outline that a list names, in its order; those of a sheet are none.
std::vector<const OutlineSamples*> listed_edges(const std::string& list, const Cloth& cloth, int panel,
                                                const InputPlace& place)
{
    std::vector<const OutlineSamples*> edges, all;
    for (const OutlineSamples& samples : cloth.outline)
        if (samples.panel == panel) all.push_back(&samples);
    for (const int edge : listed_indices(list, place)) {
        const std::string& name = cloth.panels[panel].name;
        if (edge >= int(all.size()))
            throw InputError(place, "`" + std::to_string(edge) + "`",
                             all.empty() ? name + " is a sheet, whose edges are chosen by `group`"
                                         : "edges from 0 to " + std::to_string(all.size() - 1) + " of " + name);
        edges.push_back(all[edge]);
    }
    return edges;
}

std::vector<int> chosen_panels(const Cloth& cloth, const std::string& name, const InputPlace& place)
{
    std::vector<int> panels;
    std::vector<std::string> names;
    for (int p = 0; p < int(cloth.panels.size()); ++p) {
        names.push_back(cloth.panels[p].name);
        if (name.empty() ? is_sheet(cloth, p) : names.back() == name) panels.push_back(p);
    }
    if (!panels.empty()) return panels;
    std::string expected = "one of";
    for (const std::string& known : names) expected += (known == names.front() ? " \"" : ", \"") + known + "\"";
    throw InputError(place, "`" + name + "`", expected, nearest_name(name, names));
}

}  // namespace

std::vector<int> chosen_vertices(const Cloth& cloth, const PinChoice& choice, const PinPlaces& places)
{
    std::vector<int> chosen;
    for (const int p : chosen_panels(cloth, choice.panel, places.panel)) {
        const ClothPanel& panel = cloth.panels[p];
        std::set<int> vertices = group_vertices(choice.group, cloth, panel);
        vertices.merge(listed_vertices(choice.list, panel, places.list));
        for (const OutlineSamples* edge : listed_edges(choice.edges, cloth, p, places.edges))
            for (const int vertex : edge->vertices) vertices.insert(vertex - panel.first_vertex);
        for (const int vertex : vertices) chosen.push_back(panel.first_vertex + vertex);
    }
    return chosen;
}

void sew_elastic(Cloth& cloth, const ElasticScene& elastic, const InputPlace& panel_place,
                 const InputPlace& edges_place)
{
    for (const int p : chosen_panels(cloth, elastic.panel, panel_place))
        for (const OutlineSamples* edge : listed_edges(elastic.edges, cloth, p, edges_place))
            cloth.elastics.push_back({edge->vertices, elastic.length, elastic.stiffness});
}

void hold_vertices(Cloth& cloth, const std::vector<int>& vertices)
{
    std::set<int> held(cloth.pinned.begin(), cloth.pinned.end());
    held.insert(vertices.begin(), vertices.end());
    cloth.pinned.assign(held.begin(), held.end());
}

void move_vertices(Cloth& cloth, const std::vector<int>& vertices, const PinMotionScene& motion)
{
    hold_vertices(cloth, vertices);
    cloth.pin_motions.push_back({vertices, motion.start, motion.end, motion.velocity,
                                 motion.turns == 0 ? Vec3(Vec3::UnitZ()) : Vec3(motion.axis.normalized()), motion.point,
                                 motion.turns});
}

}  // namespace selvage
