#pragma once

namespace selvage {

/// Items that take part: all of [0, count), or `count` of them that a list names in ascending order.
struct Items {
    int count = 0;
    const int* list = nullptr;  ///< Null: all.
};

}  // namespace selvage
