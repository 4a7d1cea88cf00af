#include "io/pattern/pattern_json.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>

#include <Eigen/Geometry>

#include "io/file_text.hpp"
#include "io/mesh/axes.hpp"
#include "io/number_text.hpp"
#include "io/pattern/json_cursor.hpp"
#include "io/pattern/pattern_edges.hpp"
#include "io/utf8.hpp"

namespace selvage {
namespace {

// Limits beyond which a panel's unit or placement is a mistake. They were chosen by hand, far outside those of clothes.
struct PanelLimits {
    static constexpr double smallest = 0.005, largest = 5;  // longest side of the bounding box [m]
    static constexpr double largest_distance = 100;         // distance from the origin [m]
};

// Suggests a unit in which a panel has a plausible size; empty if there is none.
std::string unit_hint(double extent_in_units)
{
    for (const double units : {100.0, 1000.0, 1.0, 39.37}) {
        const double metres = extent_in_units / units;
        if (metres >= 0.05 && metres <= 3) return "properties.units_in_meter = " + number_text(units);
    }
    return {};
}

// Reads one file; its members are what the reading of every panel needs.
class PatternReader {
public:
    PatternReader(const JsonCursor& root, const PatternConventions& conventions)
        : root_(root), conventions_(conventions)
    {
    }

    Pattern read();

private:
    void read_properties();
    std::vector<std::string> panel_order(const JsonCursor& panels) const;
    PatternPanel read_panel(const std::string& name, const JsonCursor& cursor);
    void read_vertices(const JsonCursor& cursor, PatternPanel& panel) const;
    void read_placement(const JsonCursor& cursor, PatternPanel& panel);
    void read_wrap(const JsonCursor& cursor, PatternPanel& panel) const;
    void note_rotation_order();
    void read_stitch(const JsonCursor& cursor);
    StitchSide read_side(const JsonCursor& cursor) const;
    void claim_edge(StitchSide side, const JsonCursor& cursor, const std::string& stitch);

    JsonCursor root_;
    const PatternConventions& conventions_;
    PatternUnits units_;
    Pattern pattern_;
    std::vector<std::string> turned_twice_;                ///< Paths of rotations about more than one axis.
    std::map<std::pair<int, int>, std::string> stitched_;  ///< Maps (panel, edge) to the stitch that uses it.
};

Pattern PatternReader::read()
{
    root_.object();
    read_properties();
    const JsonCursor pattern = root_.at("pattern");
    const JsonCursor panels = pattern.at("panels").object();
    if (panels.size() == 0) panels.refuse_as("no panels", "at least one panel");
    for (const std::string& name : panel_order(panels)) pattern_.panels.push_back(read_panel(name, panels.at(name)));
    note_rotation_order();

    if (!pattern.has("stitches")) return std::move(pattern_);
    const JsonCursor stitches = pattern.at("stitches").list("a list of stitches");
    for (int stitch = 0; stitch < stitches.size(); ++stitch) read_stitch(stitches.at(stitch));
    return std::move(pattern_);
}

void PatternReader::read_properties()
{
    const JsonCursor properties = root_.at("properties");
    const JsonCursor units = properties.at("units_in_meter");
    const std::string expected = "units per metre, above 0 and up to 1e6, such as 100 for cm";
    const double per_metre = units.number(expected);
    if (!(per_metre > 0 && per_metre <= 1e6)) units.refuse(expected);
    units_.scale = 1 / per_metre;
    pattern_.units_in_meter = per_metre;
    if (!properties.has("curvature_coords")) return;
    const JsonCursor coordinates = properties.at("curvature_coords");
    const std::vector<std::string> words{"relative", "absolute"};
    const std::string word = coordinates.text("\"relative\" or \"absolute\"");
    if (std::find(words.begin(), words.end(), word) == words.end())
        coordinates.refuse("\"relative\" or \"absolute\"", nearest_name(word, words));
    units_.relative_controls = word == "relative";
}

// Returns the panels in the order of the key `panel_order`; panels that it leaves out follow in the order of the file.
std::vector<std::string> PatternReader::panel_order(const JsonCursor& panels) const
{
    std::vector<std::string> all, order;
    for (const auto& [name, value] : panels.value().items()) all.push_back(name);
    if (root_.at("pattern").has("panel_order")) {
        const JsonCursor list = root_.at("pattern").at("panel_order").list("a list of panel names");
        for (int k = 0; k < list.size(); ++k) {
            const std::string name = list.at(k).text("a panel's name");
            if (!panels.value().contains(name)) list.at(k).refuse("the name of a panel", nearest_name(name, all));
            if (std::find(order.begin(), order.end(), name) != order.end()) list.at(k).refuse("each panel once");
            order.push_back(name);
        }
    }
    for (const std::string& name : all)
        if (std::find(order.begin(), order.end(), name) == order.end()) order.push_back(name);
    return order;
}

PatternPanel PatternReader::read_panel(const std::string& name, const JsonCursor& cursor)
{
    PatternPanel panel;
    panel.name = name;
    read_vertices(cursor.at("vertices"), panel);
    read_edges(cursor.at("edges"), units_, panel, pattern_.findings);
    read_placement(cursor, panel);
    if (cursor.has("wrap")) read_wrap(cursor.at("wrap"), panel);
    return panel;
}

void PatternReader::read_vertices(const JsonCursor& cursor, PatternPanel& panel) const
{
    cursor.list("a list of points [x, y]");
    if (cursor.size() < 2) cursor.refuse_as(std::to_string(cursor.size()) + " vertices", "at least 2 vertices");
    for (int vertex = 0; vertex < cursor.size(); ++vertex)
        panel.vertices.push_back(units_.scale * cursor.at(vertex).vector2("a point [x, y] of finite numbers"));
    Vec2 low = panel.vertices.front(), high = low;
    for (const Vec2& vertex : panel.vertices) {
        low = low.cwiseMin(vertex);
        high = high.cwiseMax(vertex);
    }
    const double extent = (high - low).maxCoeff();
    if (extent >= PanelLimits::smallest && extent <= PanelLimits::largest) return;
    cursor.refuse_as(
        "a panel that measures " + rounded_text(extent) + " m with units_in_meter = " + rounded_text(1 / units_.scale),
        "a panel of " + range_text(PanelLimits::smallest, PanelLimits::largest, "m") +
            "; units_in_meter = " + unit_meanings(extent / units_.scale),
        unit_hint(extent / units_.scale));
}

void PatternReader::read_placement(const JsonCursor& cursor, PatternPanel& panel)
{
    // Files of the format leave out what is zero.
    Vec3 moved = Vec3::Zero(), angles = Vec3::Zero();
    if (cursor.has("translation")) {
        const JsonCursor translation = cursor.at("translation");
        moved = units_.scale * translation.vector3("three numbers [x, y, z]");
        if (!(moved.norm() <= PanelLimits::largest_distance))
            translation.refuse("a place within " + number_text(PanelLimits::largest_distance) + " m of the origin");
    }
    if (cursor.has("rotation")) {
        const JsonCursor rotation = cursor.at("rotation");
        angles = rotation.vector3("three angles [x, y, z] in degrees");
        if (!(angles.cwiseAbs().maxCoeff() <= 1e4)) rotation.refuse("angles within 10000 degrees");
    }

    constexpr double degree = 3.14159265358979323846 / 180;
    Mat3 turn = Mat3::Identity();
    int axes_used = 0;
    for (const char name : word_of(conventions_.rotation_order)) {
        const int axis = name - 'x';
        turn = Eigen::AngleAxisd(angles[axis] * degree, Vec3::Unit(axis)).toRotationMatrix() * turn;
        axes_used += std::abs(std::remainder(angles[axis], 360)) > 1e-9;
    }
    if (axes_used > 1) turned_twice_.push_back(cursor.path() + ".rotation");
    const Mat3 up = z_up_from(find_word<Axis>(word_of(conventions_.up)).value_or(Axis::y));
    panel.rotation = up * turn;
    panel.translation = up * moved;
}

void PatternReader::read_wrap(const JsonCursor& cursor, PatternPanel& panel) const
{
    PanelWrap wrap;
    const std::string expected = "a radius above 0 and up to 100 m, in the pattern's unit";
    wrap.radius = units_.scale * cursor.at("radius").number(expected);
    if (!(wrap.radius > 0 && wrap.radius <= PanelLimits::largest_distance)) cursor.at("radius").refuse(expected);
    if (cursor.has("x0")) wrap.x0 = units_.scale * cursor.at("x0").number("a number in the pattern's unit");
    if (cursor.has("behind")) wrap.behind = cursor.at("behind").flag("true or false");
    if (cursor.has("fold")) {
        const std::string length = "0 or a length of 1 mm to 1 m, in the pattern's unit";
        wrap.fold = units_.scale * cursor.at("fold").number(length);
        if (wrap.fold != 0 && !(wrap.fold >= 0.001 && wrap.fold <= 1)) cursor.at("fold").refuse(length);
    }
    if (cursor.has("fold_angle")) {
        wrap.fold_angle = cursor.at("fold_angle").number("an angle in radians");
        if (!(std::abs(wrap.fold_angle) <= 2)) cursor.at("fold_angle").refuse("an angle of -2 to 2 rad");
    }
    panel.wrap = wrap;
}

void PatternReader::note_rotation_order()
{
    if (turned_twice_.empty() || conventions_.order_is_given) return;
    const std::size_t others = turned_twice_.size() - 1;
    pattern_.findings.push_back({"rotation", root_.place_of(turned_twice_.front()),
                                 "turns about several axes" +
                                     (others > 0 ? ", as " + std::to_string(others) + " more do" : std::string()) +
                                     ", for which writers of this format use different orders: taken as `" +
                                     text_of(conventions_.rotation_order) + "`",
                                 "garment.rotation_order sets the order"});
}

StitchSide PatternReader::read_side(const JsonCursor& cursor) const
{
    const JsonCursor panel = cursor.at("panel"), edge = cursor.at("edge");
    const std::string name = panel.text("a panel's name");
    std::vector<std::string> names;
    for (const PatternPanel& candidate : pattern_.panels) names.push_back(candidate.name);
    const auto found = std::find(names.begin(), names.end(), name);
    if (found == names.end()) panel.refuse("the name of a panel", nearest_name(name, names));

    StitchSide side;
    side.panel = int(found - names.begin());
    const int edge_count = int(pattern_.panels[std::size_t(side.panel)].edges.size());
    const std::string expected = "an edge of `" + name + "`, 0 to " + std::to_string(edge_count - 1);
    side.edge = edge.integer(expected);
    if (side.edge < 0 || side.edge >= edge_count) edge.refuse(expected);
    return side;
}

void PatternReader::claim_edge(StitchSide side, const JsonCursor& cursor, const std::string& stitch)
{
    const auto [other, is_free] = stitched_.insert({{side.panel, side.edge}, stitch});
    if (is_free) return;
    cursor.refuse_as("edge " + std::to_string(side.edge) + " of `" + pattern_.panels[std::size_t(side.panel)].name +
                         "`, which is already in " + other->second,
                     "an edge that is in no other stitch");
}

void PatternReader::read_stitch(const JsonCursor& cursor)
{
    const std::string expected = "two edges [{panel, edge}, {panel, edge}], optionally with \"right_wrong\"";
    cursor.list(expected);
    if (cursor.size() != 2 && cursor.size() != 3) cursor.refuse(expected);
    PatternStitch stitch;
    stitch.a = read_side(cursor.at(0));
    stitch.b = read_side(cursor.at(1));
    claim_edge(stitch.a, cursor.at(0), cursor.path());
    claim_edge(stitch.b, cursor.at(1), cursor.path());
    if (cursor.size() == 3) {
        const JsonCursor third = cursor.at(2);
        if (third.value().is_string() && third.value() != "right_wrong") third.refuse("\"right_wrong\"", "right_wrong");
        stitch.same_direction = third.value().is_string() || third.flag("\"right_wrong\", true or false");
    }
    pattern_.stitches.push_back(stitch);
}

}  // namespace

Pattern read_pattern_json(const std::string& path, const PatternConventions& conventions)
{
    const std::string text = read_file_text(path, "a pattern file (GarmentCode JSON)");
    JsonDocument document = parse_json(text, path);
    Pattern pattern = PatternReader(JsonCursor(document), conventions).read();
    pattern.file = path;
    pattern.text = std::move(document.text);
    pattern.name = valid_utf8(std::filesystem::path(path).stem().string());
    return pattern;
}

}  // namespace selvage
