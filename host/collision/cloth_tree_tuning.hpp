#pragma once
#include <cstddef>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

namespace selvage {

/// Chosen by hand; not measured, unless said. All but the flatness affect speed only.
struct ClothTreeTuning {
    // Least s - e [1] of a subtree that a search skips, and of one that stays skipped without a new search. The second
    // is smaller, so that small changes of the shape cause no searches. Points of a skipped subtree that are within the
    // reach are at most reach / flatness apart at rest.
    static constexpr double skip_flatness = 0.4, keep_flatness = 0.25;
    static constexpr double slack_per_move = 0.02;  // slack of a corner over the length of its move [1]
    // Above this share of the corners [1] a partial search would find little known, and after so many of them pairs
    // that have long been far apart are dropped by a search of all.
    static constexpr double most_marked = 0.9;
    static constexpr int most_partial = 32;
    static constexpr int items_per_task = 512;         // corners, edges, faces or nodes
    static constexpr std::size_t search_pieces = 256;  // node pairs from which on a search runs in parallel
};

/// Runs `work(i)` for every i in [0, count) on the TBB threads.
template <class Work>
void for_each_part(int count, const Work& work)
{
    tbb::parallel_for(tbb::blocked_range<int>(0, count, ClothTreeTuning::items_per_task), [&](const auto& range) {
        for (int i = range.begin(); i < range.end(); ++i) work(i);
    });
}

}  // namespace selvage
