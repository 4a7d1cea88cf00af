#pragma once
#include <limits>
#include <string>
#include <vector>

#include "io/choices.hpp"
#include "io/geometry.hpp"
#include "io/scene/scene_keys.hpp"

namespace selvage {

/// Marks a number that the user did not give; test with std::isnan.
inline constexpr double automatic = std::numeric_limits<double>::quiet_NaN();

// One struct per table of io/scene/scene_keys.hpp, with the defaults given there.
#define SCENE_KEY(type, name, initial, unit, low, high, meaning) type name = initial;
#define SCENE_WORD(name, initial, meaning) std::string name = initial;
#define SCENE_CHOICE(name, type, initial, meaning) type name = type::initial;
#define SCENE_VEC3(name, x, y, z, unit, meaning) Vec3 name{x, y, z};
#define SCENE_TABLE(name, type, keys, meaning)                \
    struct type {                                             \
        keys(SCENE_KEY, SCENE_WORD, SCENE_CHOICE, SCENE_VEC3) \
    };
SCENE_TABLES(SCENE_TABLE)
#undef SCENE_TABLE
struct ElasticScene {
    ELASTIC_KEYS(SCENE_KEY, SCENE_WORD, SCENE_CHOICE, SCENE_VEC3)
};
struct SheetScene {
    SHEET_KEYS(SCENE_KEY, SCENE_WORD, SCENE_CHOICE, SCENE_VEC3)
};
struct KeyframeScene {
    KEYFRAME_KEYS(SCENE_KEY, SCENE_WORD, SCENE_CHOICE, SCENE_VEC3)
};
struct BodyScene {
    BODY_KEYS(SCENE_KEY, SCENE_WORD, SCENE_CHOICE, SCENE_VEC3)
    std::vector<KeyframeScene> keyframes;  ///< [[body.keyframe]]
    bool moves() const { return !keyframes.empty() || !sequence.empty(); }
};
struct PinHoldScene {
    PIN_HOLD_KEYS(SCENE_KEY, SCENE_WORD, SCENE_CHOICE, SCENE_VEC3)
};
struct PinMotionScene {
    PIN_MOTION_KEYS(SCENE_KEY, SCENE_WORD, SCENE_CHOICE, SCENE_VEC3)
};
#undef SCENE_KEY
#undef SCENE_WORD
#undef SCENE_CHOICE
#undef SCENE_VEC3

}  // namespace selvage
