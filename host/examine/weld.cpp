#include "host/examine/weld.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include <tbb/parallel_sort.h>

#include "host/mesh/body_tessellation.hpp"
#include "io/number_text.hpp"

namespace selvage {
namespace {

constexpr double cell_size = 1.5;  // of the distance: above 1, so that rounding keeps near points in adjacent cells

using Cell = std::array<double, 3>;  // whole numbers

struct CellPoint {
    Cell cell;
    int point;
    bool operator<(const CellPoint& o) const { return cell != o.cell ? cell < o.cell : point < o.point; }
};

// The indices of the points in a cell.
template <class Visit>
void for_each_in(const std::vector<CellPoint>& sorted, const Cell& cell, const Visit& visit)
{
    for (auto at = std::lower_bound(sorted.begin(), sorted.end(), CellPoint{cell, -1});
         at != sorted.end() && at->cell == cell; ++at)
        visit(at->point);
}

void refuse_lost_faces(const FileMesh& mesh, double distance, const InputPlace& place, JoinedSets& sets)
{
    const double least = least_area(mesh.mesh.vertices);
    for (int f = 0; f < int(mesh.mesh.faces.size()); ++f) {
        Face face = mesh.mesh.faces[f];
        for (int& v : face) v = sets.root(v);
        if (!(area_of(mesh.mesh.vertices, face) > least))
            throw InputError(place,
                             rounded_text(distance) + " m, by which the face at line " +
                                 std::to_string(mesh.at_face(f).line) + " would lose its area",
                             "a distance below the edges and heights of all faces");
    }
}

}  // namespace

WeldRule weld_rule(const std::string& text, bool for_sheet, const InputPlace& place)
{
    constexpr double least = 1e-9, most = 0.1;
    WeldRule rule;
    if (text == "none") return rule;
    rule.seams = for_sheet && text == "seams";
    rule.any = !rule.seams;
    if (rule.seams || text == "exact") return rule;
    if (parse_number(text, rule.distance) && rule.distance >= least && rule.distance <= most) return rule;
    std::vector<std::string> words{"none", "exact"};
    if (for_sheet) words.push_back("seams");
    throw InputError(place, "`" + text + "`",
                     std::string(for_sheet ? "\"seams\", " : "") + "\"none\", \"exact\" or a distance of " +
                         range_text(least, most, "m"),
                     nearest_name(text, words));
}

void join_near(const FileMesh& mesh, double distance, const InputPlace& place, JoinedSets& sets)
{
    const std::vector<Vec3>& vertices = mesh.mesh.vertices;
    const std::vector<int> first = first_coincident_vertex(vertices);
    for (int v = 0; v < int(first.size()); ++v) sets.join(v, first[v]);
    if (distance == 0) return;
    const double size = cell_size * distance;
    std::vector<CellPoint> cells;
    for (int v = 0; v < int(vertices.size()); ++v)
        if (first[v] == v)
            cells.push_back({{std::floor(vertices[v].x() / size), std::floor(vertices[v].y() / size),
                              std::floor(vertices[v].z() / size)},
                             v});
    tbb::parallel_sort(cells.begin(), cells.end());
    for (const CellPoint& at : cells)
        for (int offset = 0; offset < 27; ++offset)
            for_each_in(cells,
                        {at.cell[0] + offset % 3 - 1, at.cell[1] + offset / 3 % 3 - 1, at.cell[2] + offset / 9 - 1},
                        [&](int other) {
                            if (other > at.point && (vertices[other] - vertices[at.point]).norm() <= distance)
                                sets.join(at.point, other);
                        });
    refuse_lost_faces(mesh, distance, place, sets);
}

}  // namespace selvage
