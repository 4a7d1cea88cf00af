#pragma once
#include <map>
#include <string>
#include <vector>

#include "io/errors.hpp"
#include "io/scene/fabric.hpp"
#include "io/scene/scene_tables.hpp"

namespace selvage {

/// How long a run goes on.
struct Until {
    bool equilibrium = true;  ///< Until the cloth is at rest.
    double time = 0;          ///< Otherwise: simulated time [s].
};

/// A whole scene: what is simulated, how, and what is written. All in SI units, z up.
struct Scene {
    std::string name;                     ///< File stem or built-in name.
    std::string file;                     ///< Path as given, or `builtin:NAME`.
    std::string folder;                   ///< Folder against which file names in the scene are resolved.
    std::string text;                     ///< The TOML text as run, overrides applied.
    std::string summary;                  ///< One sentence from the top-level key `summary`.
    std::vector<std::string> parameters;  ///< Keys that are commonly overridden.

#define SCENE_TABLE(name, type, keys, meaning) type name;
    SCENE_TABLES(SCENE_TABLE)
#undef SCENE_TABLE
    std::map<std::string, std::string> panel_fabrics;  ///< [garment.fabrics]: panel name to fabric name.
    std::map<std::string, std::string> panel_parts;    ///< [garment.parts]: panel name to what it covers.
    std::vector<ElasticScene> elastics;                ///< [[garment.elastic]]
    std::vector<SheetScene> sheets;                    ///< [[sheet]]
    std::vector<BodyScene> bodies;                     ///< [[body]]
    std::vector<PinHoldScene> pin_holds;               ///< [[pins.hold]]
    std::vector<PinMotionScene> pin_motions;           ///< [[pins.motion]]
    std::map<std::string, Fabric> fabrics;             ///< Every fabric that the scene names, resolved and checked.
    std::map<std::string, InputPlace> places;          ///< Key path to its place in the file, for later messages.

    bool has_garment() const { return !garment.pattern.empty(); }
    bool wind_blows() const;                                         ///< The air moves.
    bool has_air() const { return wind_blows() || wind.still_air; }  ///< Air acts on the cloth.
    bool moves() const;                                              ///< A body or a pin has a motion of its own.
    /// Returns solver.until.
    /// @throws InputError if it is neither the word nor a time
    Until until() const;
    /// Returns the place of a key path such as `body[0].mesh`; only the file when the key was not given.
    InputPlace place(const std::string& key) const;
    /// Returns a file name from the scene, resolved against the scene's folder.
    std::string resolve(const std::string& file_name) const;
};

}  // namespace selvage
