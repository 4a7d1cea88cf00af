#include "io/scene/fabric_table.hpp"

#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "io/choices.hpp"
#include "io/number_text.hpp"
#include "io/scene/presets.hpp"
#include "io/scene/scene_keys.hpp"

namespace selvage {
namespace {

constexpr double automatic = std::numeric_limits<double>::quiet_NaN();
constexpr const char* folder = "fabrics";

// A fabric's table as written: NaN where it is silent.
#define FABRIC_KEY(type, name, initial, unit, low, high, meaning) type name = initial;
#define FABRIC_WORD(name, initial, meaning) std::string name = initial;
#define FABRIC_CHOICE(name, type, initial, meaning) type name = type::initial;
#define FABRIC_CURVE(name, number, measure, meaning) std::vector<Vec2> name;
struct FabricTable {
    FABRIC_KEYS(FABRIC_KEY, FABRIC_WORD, FABRIC_CHOICE, FABRIC_CURVE)
};
#undef FABRIC_KEY
#undef FABRIC_WORD
#undef FABRIC_CHOICE
#undef FABRIC_CURVE

#define NOT_A_NUMBER_KEY(type, name, initial, unit, low, high, meaning)
#define NOT_A_WORD(name, initial, meaning)
#define NOT_A_CHOICE(name, type, initial, meaning)
#define NOT_A_CURVE(name, number, measure, meaning)

constexpr double largest_elongation = 10, largest_angle = 1.5;  // [1], [rad]

// A curve's points, and the number and curve of a fabric that they stand for.
struct GivenCurve {
    const char *name, *number_name;
    const std::vector<Vec2>& points;
    double given_number;
    CurveMeasure measure;
    StressCurve& curve;
    double& number;
};

// Points in the membrane's measures; a force that rises less than the stretch does would make a falling stress.
std::vector<Vec2> membrane_points(const GivenCurve& given, const InputPlace& place)
{
    std::vector<Vec2> points;
    double last = 0;
    for (const Vec2& measured : given.points) {
        points.push_back(membrane_point(given.measure, measured));
        if (points.back().y() <= last)
            throw InputError(place,
                             "a force per width of " + number_text(measured.y()) + " N/m at a strain of " +
                                 number_text(measured.x()),
                             "forces that grow faster than 1 + strain, or the sheet would yield");
        last = points.back().y();
    }
    return points;
}

// The table's own word on one direction: a curve, or a number that replaces an inherited curve, or nothing.
void merge_curve(const GivenCurve& given, CurveShape shape, const TableReader& reader)
{
    if (given.points.empty()) {
        if (!std::isnan(given.given_number)) given.curve.clear();
        return;
    }
    if (!std::isnan(given.given_number))
        throw InputError(reader.place(given.number_name),
                         "`" + std::string(given.number_name) + "` beside `" + given.name + "`",
                         "one of the two: a curve has its own slope at zero strain");
    const std::vector<Vec2> points = membrane_points(given, reader.place(given.name));
    given.curve = shape == CurveShape::smooth ? smooth_curve(points) : piecewise_curve(points);
    given.number = given.curve[0].slope;
}

void merge_curves(const FabricTable& table, const TableReader& reader, Fabric& fabric)
{
    bool any = false;
#define MERGE_CURVE(name, number, measure, meaning)                                                            \
    merge_curve({#name, #number, table.name, table.number, CurveMeasure::measure, fabric.name, fabric.number}, \
                table.curve, reader);                                                                          \
    any = any || !table.name.empty();
    FABRIC_KEYS(NOT_A_NUMBER_KEY, NOT_A_WORD, NOT_A_CHOICE, MERGE_CURVE)
#undef MERGE_CURVE
    if (!any && table.curve != CurveShape::not_given)
        throw InputError(reader.place("curve"), "a table without points",
                         "stretch_weft_curve, stretch_warp_curve or shear_curve");
}

void read_curve(TableReader& reader, const char* name, CurveMeasure measure, std::vector<Vec2>& points)
{
    const bool tension = measure == CurveMeasure::tension;
    reader.read(name, points, most_curve_points, tension ? largest_elongation : largest_angle, tension ? "m/m" : "rad");
}

void merge_number(double given, double& target)
{
    if (!std::isnan(given)) target = given;
}

void require_number(double given, const TableReader& reader, const char* name)
{
    if (!std::isnan(given)) return;
    throw InputError(reader.place(name), "nothing",
                     "a number, as neither a preset of this name nor the key `base` could give it");
}

void check_number(double value, const InputPlace& fabric, const char* name, const char* unit, double low, double high)
{
    if (std::isnan(value) || (value >= low && value <= high)) return;  // a property that may be automatic
    InputPlace place = fabric;
    place.key += (place.key.empty() ? "" : ".") + std::string(name);
    throw InputError(place, number_text(value), "a number from " + range_text(low, high, unit),
                     unit_slip(value, low, high, unit));
}

// Two stiffnesses and what couples them must resist every combination.
void require_definite(const InputPlace& fabric, const std::string& kind, double weft, double warp, double coupling,
                      const std::string& unit)
{
    const double limit = std::sqrt(weft * warp);
    if (coupling == 0 || coupling < limit) return;
    InputPlace place = fabric;
    place.key += (place.key.empty() ? "" : ".") + kind + "_coupling";
    throw InputError(
        place, number_text(coupling),
        fmt::format("less than sqrt({0}_weft * {0}_warp) = {1} {2} (of curves the smallest slopes), or some "
                    "strain would cost no energy",
                    kind, rounded_text(limit), unit));
}

}  // namespace

std::vector<std::string> fabric_preset_names() { return preset_names(folder); }

Fabric fabric_preset(const std::string& name)
{
    const PresetFile* file = find_preset(folder, name);
    if (!file)
        throw InputError({{}, 0, 0, "fabric"}, "`" + name + "`", "a fabric's name, which `selvage schema` lists",
                         nearest_name(name, fabric_preset_names()));
    TomlDocument document = parse_toml(file->text, "builtin:" + std::string(file->path));
    TableReader reader(document, &document.root, "");
    Fabric fabric = read_fabric_table(reader, "");
    fabric.name = name;
    return fabric;
}

Fabric read_fabric_table(TableReader& reader, const std::string& name)
{
    FabricTable table;
#define READ_KEY(type, name, initial, unit, low, high, meaning) reader.read(#name, table.name, unit, low, high);
#define READ_WORD(name, initial, meaning) reader.read(#name, table.name);
#define READ_CHOICE(name, type, initial, meaning) reader.read(#name, table.name);
#define READ_CURVE(name, number, measure, meaning) read_curve(reader, #name, CurveMeasure::measure, table.name);
    FABRIC_KEYS(READ_KEY, READ_WORD, READ_CHOICE, READ_CURVE)
#undef READ_KEY
#undef READ_WORD
#undef READ_CHOICE
#undef READ_CURVE
    reader.refuse_unknown();

    const bool refines = table.base.empty() && find_preset(folder, name);
    if (!table.base.empty() && !find_preset(folder, table.base))
        throw InputError(reader.place("base"), "`" + table.base + "`", "the name of a built-in fabric",
                         nearest_name(table.base, fabric_preset_names()));
    Fabric fabric;
    if (refines || !table.base.empty()) {
        fabric = fabric_preset(refines ? name : table.base);
    } else {
        require_number(table.areal_density, reader, "areal_density");
#define REQUIRE(name, number, measure, meaning) \
    if (table.name.empty()) require_number(table.number, reader, #number);
        FABRIC_KEYS(NOT_A_NUMBER_KEY, NOT_A_WORD, NOT_A_CHOICE, REQUIRE)
#undef REQUIRE
        require_number(table.bending_weft, reader, "bending_weft");
        require_number(table.bending_warp, reader, "bending_warp");
    }
#define MERGE_KEY(type, name, initial, unit, low, high, meaning) merge_number(table.name, fabric.name);
    FABRIC_KEYS(MERGE_KEY, NOT_A_WORD, NOT_A_CHOICE, NOT_A_CURVE)
#undef MERGE_KEY
    merge_curves(table, reader, fabric);
    if (!table.source.empty()) fabric.source = table.source;
    fabric.name = name;

    InputPlace place = reader.place("");
    place.key = reader.path();
    check_fabric(fabric, place);
    return fabric;
}

std::vector<Fabric> read_fabrics(const std::string& text, const std::string& file)
{
    TomlDocument document = parse_toml(text, file);
    std::vector<Fabric> fabrics;
    if (document.root.contains("areal_density") || document.root.contains("base")) {
        TableReader reader(document, &document.root, "");
        fabrics.push_back(read_fabric_table(reader, ""));
    }
    toml::table* tables = document.root.size() == 1 ? document.root["fabric"].as_table() : nullptr;
    if (!tables) return fabrics;
    for (auto&& [key, node] : *tables) {
        const std::string name(key.str());
        if (!node.is_table()) return {};
        TableReader reader(document, node.as_table(), "fabric." + name);
        fabrics.push_back(read_fabric_table(reader, name));
    }
    return fabrics;
}

void check_fabric(const Fabric& fabric, const InputPlace& place)
{
#define CHECK_KEY(type, name, initial, unit, low, high, meaning) \
    check_number(fabric.name, place, #name, unit, low, high);
    FABRIC_KEYS(CHECK_KEY, NOT_A_WORD, NOT_A_CHOICE, NOT_A_CURVE)
#undef CHECK_KEY
    const std::array<StressCurve, 3> curves = membrane_curves(fabric);
    require_definite(place, "stretch", std::max(0.0, smallest_slope(curves[0])),
                     std::max(0.0, smallest_slope(curves[1])), fabric.stretch_coupling, "N/m");
    require_definite(place, "bending", fabric.bending_weft, fabric.bending_warp, fabric.bending_coupling, "N m");
}

void check_fabric(const Fabric& fabric, const std::string& file, const std::string& key)
{
    check_fabric(fabric, InputPlace{file, 0, 0, key});
}

}  // namespace selvage
