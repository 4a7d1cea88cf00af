#include "io/content_hash.hpp"

#include <fmt/format.h>

namespace selvage {

std::string ContentHash::text() const { return fmt::format("{:016x}", value_); }

}  // namespace selvage
