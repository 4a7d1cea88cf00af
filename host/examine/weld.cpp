#include "host/examine/weld.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <tbb/parallel_sort.h>

#include "host/mesh/body_tessellation.hpp"
#include "io/number_text.hpp"

namespace selvage {
namespace {

using Cell = std::array<long long, 3>;

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

void join_near(const std::vector<Vec3>& vertices, const std::vector<Face>& faces, double distance,
               const InputPlace& place, JoinedSets& sets)
{
    const std::vector<int> first = first_coincident_vertex(vertices);
    for (int v = 0; v < int(first.size()); ++v) sets.join(v, first[v]);
    if (distance == 0) return;
    double shortest = std::numeric_limits<double>::infinity();
    for (const Face& face : faces)
        for (int k = 0; k < 3; ++k)
            shortest = std::min(shortest, (vertices[face[k]] - vertices[face[(k + 1) % 3]]).norm());
    if (!(shortest > 2 * distance))
        throw InputError(place,
                         rounded_text(distance) + " m, where the shortest edge is " + rounded_text(shortest) + " m",
                         "less than half the shortest edge, as faces would vanish");
    std::vector<CellPoint> cells;
    for (int v = 0; v < int(vertices.size()); ++v)
        if (first[v] == v)
            cells.push_back({{std::llround(vertices[v].x() / distance), std::llround(vertices[v].y() / distance),
                              std::llround(vertices[v].z() / distance)},
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
}

}  // namespace selvage
