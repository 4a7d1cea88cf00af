#include "io/fabric.hpp"

#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "io/fabric_table.hpp"
#include "io/number_text.hpp"
#include "io/presets.hpp"
#include "io/scene_keys.hpp"

namespace selvage {
namespace {

constexpr double automatic = std::numeric_limits<double>::quiet_NaN();
constexpr const char* folder = "fabrics";

// A fabric's table as written: NaN where it is silent.
#define FABRIC_KEY(type, name, initial, unit, low, high, meaning) type name = initial;
#define FABRIC_WORD(name, initial, choices, meaning) std::string name = initial;
struct FabricTable {
    FABRIC_KEYS(FABRIC_KEY, FABRIC_WORD)
};
#undef FABRIC_KEY
#undef FABRIC_WORD

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
    if (std::isnan(value) || (value >= low && value <= high)) return;   // a property that may be automatic
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
    throw InputError(place, number_text(coupling),
                     fmt::format("less than sqrt({0}_weft * {0}_warp) = {1} {2}, or some strain would cost no energy",
                                 kind, rounded_text(limit), unit));
}

}  // namespace

double twist_rigidity(const Fabric& fabric)
{
    if (!std::isnan(fabric.bending_twist)) return fabric.bending_twist;
    return 2 * (std::sqrt(fabric.bending_weft * fabric.bending_warp) - fabric.bending_coupling);
}

std::vector<std::string> fabric_preset_names()
{
    return preset_names(folder);
}

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
#define READ_WORD(name, initial, choices, meaning) reader.read(#name, table.name, choices);
    FABRIC_KEYS(READ_KEY, READ_WORD)
#undef READ_KEY
#undef READ_WORD
    reader.refuse_unknown();

    const bool refines = table.base.empty() && find_preset(folder, name);
    if (!table.base.empty() && !find_preset(folder, table.base))
        throw InputError(reader.place("base"), "`" + table.base + "`", "the name of a built-in fabric",
                         nearest_name(table.base, fabric_preset_names()));
    Fabric fabric;
    if (refines || !table.base.empty()) {
        fabric = fabric_preset(refines ? name : table.base);
    } else {
        for (const auto& [value, key] : {std::pair(table.areal_density, "areal_density"),
                                         std::pair(table.stretch_weft, "stretch_weft"),
                                         std::pair(table.stretch_warp, "stretch_warp"),
                                         std::pair(table.shear, "shear"),
                                         std::pair(table.bending_weft, "bending_weft"),
                                         std::pair(table.bending_warp, "bending_warp")})
            require_number(value, reader, key);
    }
#define MERGE_KEY(type, name, initial, unit, low, high, meaning) merge_number(table.name, fabric.name);
#define IGNORE_WORD(name, initial, choices, meaning)
    FABRIC_KEYS(MERGE_KEY, IGNORE_WORD)
#undef MERGE_KEY
    if (!table.source.empty()) fabric.source = table.source;
    fabric.name = name;

    InputPlace place = reader.place("");
    place.key = reader.path();
    check_fabric(fabric, place);
    return fabric;
}

void check_fabric(const Fabric& fabric, const InputPlace& place)
{
#define CHECK_KEY(type, name, initial, unit, low, high, meaning) \
    check_number(fabric.name, place, #name, unit, low, high);
    FABRIC_KEYS(CHECK_KEY, IGNORE_WORD)
#undef CHECK_KEY
#undef IGNORE_WORD
    require_definite(place, "stretch", fabric.stretch_weft, fabric.stretch_warp, fabric.stretch_coupling, "N/m");
    require_definite(place, "bending", fabric.bending_weft, fabric.bending_warp, fabric.bending_coupling, "N m");
}

void check_fabric(const Fabric& fabric, const std::string& file, const std::string& key)
{
    check_fabric(fabric, InputPlace{file, 0, 0, key});
}

}  // namespace selvage
