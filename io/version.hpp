#pragma once

namespace selvage {

/// The program's version; CMakeLists.txt reads it from this line.
inline constexpr const char* version = "0.1.0";

}  // namespace selvage
