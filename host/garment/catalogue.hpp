#pragma once
#include <string>
#include <vector>

#include "io/choices.hpp"
#include "io/pattern/pattern.hpp"

namespace selvage {

/// Names of the built-in patterns: "tshirt" (front, back, left_sleeve, right_sleeve) and "vest" (front, back).
std::vector<std::string> builtin_pattern_names();

/// Drafts a built-in pattern from the measures of a mannequin size and places it around that mannequin in its
/// A-pose: front and back bent half around the torso, sleeves rolled around the arms with the underarm edges
/// below. Every panel's outside faces away from the body; its warp (y) runs upwards, or up the arm. Lengths in
/// [m], the scene's frame.
/// @param name  one of builtin_pattern_names()
/// @throws InputError for an unknown name
Pattern builtin_pattern(const std::string& name, BodySize size);

}  // namespace selvage
