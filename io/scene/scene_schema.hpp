#pragma once
#include <string>

namespace selvage {

/// Returns the documentation of every scene key as text, one line per key.
std::string scene_schema_text();

/// Returns the documentation of every scene key as JSON text.
std::string scene_schema_json();

}  // namespace selvage
