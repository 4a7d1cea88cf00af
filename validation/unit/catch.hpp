#pragma once
#include <string>

// Catch2 2 is one header. Version 3 has many, and other names for some of what the tests use.
#if __has_include(<catch2/catch_all.hpp>)
    #include <catch2/catch_all.hpp>
#else
    #include <catch2/catch.hpp>
#endif

namespace selvage {

#if CATCH_VERSION_MAJOR >= 3
using Catch::Approx;
#endif

/// Matches texts that contain `part`, as in CHECK_THROWS_WITH(f(), contains_text("sheet[0]")).
inline auto contains_text(const std::string& part)
{
#if CATCH_VERSION_MAJOR >= 3
    return Catch::Matchers::ContainsSubstring(part);
#else
    return Catch::Matchers::Contains(part);
#endif
}

}  // namespace selvage
