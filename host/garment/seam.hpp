#pragma once
#include <string>
#include <vector>

#include "host/model/cloth.hpp"
#include "io/pattern/pattern.hpp"

namespace selvage {

/// Returns the key path of a stitch, as `pattern.stitches[2]`.
std::string stitch_key(int stitch);

/// Returns the edge at one side of a stitch, as `front.edges[3]`.
std::string side_name(const Pattern& pattern, const StitchSide& side);

/// Checks that stitches name existing edges and that no edge is stitched twice.
/// @throws InputError naming the edge and both stitches
void check_stitches(const Pattern& pattern);

/// Checks that no side of a stitch is so much longer than the other that they cannot be sewn.
/// @param lengths  of the exact curves, by panel and edge [m]
/// @throws InputError naming the stitch and both lengths
void check_seam_lengths(const Pattern& pattern, const std::vector<std::vector<double>>& lengths);

/// Returns the number of equal segments of each edge of each panel: its length over `edge_length`, rounded. Both edges
/// of a stitch get the number of the longer one.
/// @param lengths  of the exact curves, by panel and edge [m]
std::vector<std::vector<int>> edge_segments(const Pattern& pattern, const std::vector<std::vector<double>>& lengths,
                                            double edge_length);

/// Pairs the vertices of stitched edges: adds Cloth::seams and Cloth::seam_pairs, every pair once.
/// @param cloth      its outline is complete, with equal sample counts on both sides of every stitch
/// @param side_of    index into cloth.outline, by panel and edge
void join_seams(const Pattern& pattern, const std::vector<std::vector<int>>& side_of, Cloth& cloth);

}  // namespace selvage
