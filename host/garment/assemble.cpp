#include "host/garment/assemble.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <numbers>
#include <stdexcept>

#include <tbb/parallel_for.h>

#include "host/garment/outline.hpp"
#include "host/garment/seam.hpp"
#include "host/mesh/grid_point.hpp"
#include "host/mesh/panel_mesh.hpp"
#include "host/mesh/renumber.hpp"
#include "io/errors.hpp"

namespace selvage {
namespace {

// Vertices per squared edge length of a mesh of equilateral triangles: 2 / sqrt(3).
constexpr double vertex_density = 1.1547;

struct MeshedPanel {
    PanelMesh mesh;
    std::vector<std::vector<int>> edge_vertices;  // by edge, from its start to its end
    double area = 0, boundary = 0;
    bool clockwise = false;  ///< The outline runs clockwise about the z axis of the panel, whose outside is then at -z.
};

std::string number_text(double value)
{
    char text[32];
    std::snprintf(text, sizeof text, "%.4g", value);
    return text;
}

void check_fabric_names(const Pattern& pattern, const std::map<std::string, std::string>& panel_fabrics)
{
    std::vector<std::string> names;
    for (const PatternPanel& panel : pattern.panels) names.push_back(panel.name);
    for (const auto& [name, fabric] : panel_fabrics)
        if (std::find(names.begin(), names.end(), name) == names.end())
            throw InputError({{}, 0, 0, "garment.fabrics." + name}, "an unknown panel `" + name + "`",
                             "the name of a panel of the pattern", nearest_name(name, names));
}

void check_size(const Pattern& pattern, const std::vector<std::vector<double>>& lengths, double edge_length,
                double max_vertices)
{
    if (!(edge_length > 0 && std::isfinite(edge_length)))
        throw InputError({{}, 0, 0, "garment.resolution"}, number_text(edge_length) + " m",
                         "an edge length above zero");
    double area = 0, vertices = 0;
    for (std::size_t panel = 0; panel < pattern.panels.size(); ++panel) {
        const std::vector<int> coarse(pattern.panels[panel].edges.size(), 16);
        area += std::abs(signed_area(sample_outline(pattern.panels[panel], coarse)));
        for (const double length : lengths[panel]) vertices += 0.5 * length / edge_length + 1;
    }
    vertices += vertex_density * area / (edge_length * edge_length);
    if (vertices > max_vertices)
        throw InputError({{}, 0, 0, "garment.resolution"},
                         number_text(edge_length) + " m, which means about " + number_text(vertices) + " vertices",
                         "at least " + number_text(edge_length * std::sqrt(vertices / max_vertices)) +
                             " m for at most " + number_text(max_vertices) + " vertices");
}

MeshedPanel mesh_one(const PatternPanel& panel, const std::vector<int>& segments, double edge_length)
{
    std::vector<Vec2> polygon = sample_outline(panel, segments);
    const int sample_count = int(polygon.size());
    const bool clockwise = signed_area(polygon) < 0;
    if (clockwise) std::reverse(polygon.begin(), polygon.end());
    MeshedPanel result;
    try {
        result.mesh = mesh_panel(polygon, edge_length);
    } catch (const std::invalid_argument& error) {
        throw InputError(
            {{}, 0, 0, "garment.resolution"},
            number_text(edge_length) + " m, at which panel `" + panel.name + "` overlaps itself (" + error.what() + ")",
            "a shorter edge length");
    }
    const std::vector<int> renumbered = renumber_for_locality(result.mesh.vertices, result.mesh.faces);
    int sample = 0;
    for (const int count : segments) {
        result.edge_vertices.emplace_back();
        for (int i = 0; i <= count; ++i) {
            const int k = (sample + i) % sample_count;
            result.edge_vertices.back().push_back(renumbered[clockwise ? sample_count - 1 - k : k]);
        }
        sample += count;
    }
    for (int i = 0; i < sample_count; ++i) result.boundary += (polygon[(i + 1) % sample_count] - polygon[i]).norm();
    result.area = signed_area(polygon);
    result.clockwise = clockwise;
    return result;
}

// Meshes the panels in parallel. If several fail, the exception of the first one is thrown.
std::vector<MeshedPanel> mesh_all(const Pattern& pattern, const std::vector<std::vector<int>>& segments,
                                  double edge_length)
{
    const int count = int(pattern.panels.size());
    std::vector<MeshedPanel> meshed(count);
    std::vector<std::exception_ptr> faults(count);
    tbb::parallel_for(0, count, [&](int panel) {
        try {
            meshed[panel] = mesh_one(pattern.panels[panel], segments[panel], edge_length);
        } catch (...) {
            faults[panel] = std::current_exception();
        }
    });
    for (const std::exception_ptr& fault : faults)
        if (fault) std::rethrow_exception(fault);
    return meshed;
}

// Adds one panel to the cloth and returns the indices of its edges in Cloth::outline.
std::vector<int> add_panel(Cloth& cloth, const PatternPanel& panel, const MeshedPanel& meshed,
                           const std::vector<double>& lengths, const std::string& fabric)
{
    const int first_vertex = int(cloth.positions.size());
    cloth.panels.push_back({panel.name,
                            fabric,
                            first_vertex,
                            int(meshed.mesh.vertices.size()),
                            int(cloth.faces.size()),
                            int(meshed.mesh.faces.size()),
                            meshed.area,
                            meshed.boundary,
                            meshed.clockwise,
                            {}});
    for (const Vec2& point : meshed.mesh.vertices) {
        cloth.panel_coordinates.push_back(point);
        cloth.positions.push_back(place_on_panel(panel, point));
    }
    for (const Face& face : meshed.mesh.faces)
        cloth.faces.push_back({face[0] + first_vertex, face[1] + first_vertex, face[2] + first_vertex});
    std::vector<int> sides;
    for (int edge = 0; edge < int(panel.edges.size()); ++edge) {
        OutlineSamples samples{int(cloth.panels.size()) - 1, edge, {}, {}, lengths[edge]};
        const std::vector<int>& vertices = meshed.edge_vertices[edge];
        for (std::size_t i = 0; i < vertices.size(); ++i) {
            samples.vertices.push_back(vertices[i] + first_vertex);
            samples.parameters.push_back(double(i) / double(vertices.size() - 1));
        }
        sides.push_back(int(cloth.outline.size()));
        cloth.outline.push_back(std::move(samples));
    }
    return sides;
}

// Vertices that are sewn together and start at one place but for rounding start there exactly: what is joined is told
// by that.
void unite_positions(Cloth& cloth)
{
    constexpr double rounding = 1e-9;  // [m]
    const auto before = [](const Vec3& a, const Vec3& b) {
        return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end());
    };
    for (bool changed = true; changed;) {
        changed = false;
        for (const auto& [a, b] : cloth.seam_pairs) {
            Vec3 &x = cloth.positions[a], &y = cloth.positions[b];
            if (x == y || (x - y).norm() > rounding) continue;
            (before(x, y) ? y : x) = before(x, y) ? x : y;
            changed = true;
        }
    }
}

}  // namespace

Vec2 place_on_bend(const PanelWrap& wrap, double x)
{
    const double way = x - wrap.x0;
    if (wrap.fold == 0)
        return {wrap.radius * std::sin(way / wrap.radius), wrap.radius * (1 - std::cos(way / wrap.radius))};
    constexpr int parts_of_fold = 24;  // each with one point of the midpoint rule: an error below 1e-3 of a fold
    const int parts = std::max(1, int(std::ceil(std::abs(way) / wrap.fold * parts_of_fold)));
    Vec2 at = Vec2::Zero();
    for (int k = 0; k < parts; ++k) {
        const double s = (k + 0.5) / parts * way;
        const double angle = s / wrap.radius + wrap.fold_angle * std::sin(2 * std::numbers::pi * s / wrap.fold);
        at += way / parts * Vec2(std::cos(angle), std::sin(angle));
    }
    return at;
}

Vec3 place_on_panel(const PatternPanel& panel, const Vec2& point)
{
    Vec3 rolled(point.x(), point.y(), 0);
    if (panel.wrap) {
        const Vec2 bent = place_on_bend(*panel.wrap, point.x());
        rolled.x() = panel.wrap->x0 + bent.x();
        rolled.z() = panel.wrap->behind ? bent.y() : -bent.y();
    }
    return panel.rotation * rolled + panel.translation;
}

Cloth assemble_garment(const Pattern& pattern, double edge_length, const std::string& garment_fabric,
                       const std::map<std::string, std::string>& panel_fabrics, double max_vertices)
{
    Cloth cloth;
    for (const PatternPanel& panel : pattern.panels) check_outline(pattern, panel, cloth.findings);
    check_stitches(pattern);
    check_fabric_names(pattern, panel_fabrics);
    std::vector<std::vector<double>> lengths;
    for (const PatternPanel& panel : pattern.panels) {
        lengths.emplace_back();
        for (const PatternEdge& edge : panel.edges) lengths.back().push_back(EdgePath(panel, edge).length());
    }
    check_seam_lengths(pattern, lengths);
    check_size(pattern, lengths, edge_length, max_vertices);
    const std::vector<MeshedPanel> meshed =
        mesh_all(pattern, edge_segments(pattern, lengths, edge_length), edge_length);

    std::vector<std::vector<int>> side_of;
    for (std::size_t index = 0; index < pattern.panels.size(); ++index) {
        const PatternPanel& panel = pattern.panels[index];
        const auto chosen = panel_fabrics.find(panel.name);
        const std::string& fabric = chosen != panel_fabrics.end() ? chosen->second
                                    : panel.fabric.empty()        ? garment_fabric
                                                                  : panel.fabric;
        side_of.push_back(add_panel(cloth, panel, meshed[index], lengths[index], fabric));
    }
    join_seams(pattern, side_of, cloth);
    unite_positions(cloth);
    return cloth;
}

}  // namespace selvage
