#pragma once

namespace selvage {

/// The items that a launch works on: all of [0, count), or those of a list of `count` indices.
struct Items {
    int count = 0;
    const int* list = nullptr;  ///< Ascending indices; null: all of [0, count).
};

}  // namespace selvage
