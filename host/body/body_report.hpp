#pragma once
#include <string>

#include "host/body/body_measures.hpp"

namespace selvage {

/// Returns the measures as a table in centimetres.
/// @param name  of the body, as the user gave it
std::string measures_text(const BodyMeasures& measures, const std::string& name);

/// Returns the measures as JSON in SI units, with the part of each vertex.
std::string measures_json(const BodyMeasures& measures, const std::string& name);

}  // namespace selvage
