#pragma once
#include <vector>

#include "host/parallel/items.hpp"
#include "host/solver/state/planes.hpp"
#include "host/solver/state/state.hpp"

namespace selvage {

// Launches of kernels/stages/vector_ops.h. Fields that one call takes have equal sizes and may be the same one.
// Sums and maxima are the same whatever the thread count.

/// y = 0 in every entry.
void clear(std::vector<real>& y);
void clear(std::vector<block_real>& blocks);

/// y = factor y.
void scale(std::vector<real>& y, real factor);

/// y = y / divisor.
void divide(std::vector<real>& y, real divisor);

/// y = x + factor p.
void add(std::vector<real>& y, const std::vector<real>& x, real factor, const std::vector<real>& p);

/// y = factor (x - p).
void scale_difference(std::vector<real>& y, real factor, const std::vector<real>& x, const std::vector<real>& p);

/// y = sqrt(x).
void root(std::vector<real>& y, const std::vector<real>& x);

/// y = weight x with one weight per vertex.
void weigh(Planes y, const std::vector<real>& weight, ConstPlanes x);

/// y = x - p at free vertices and 0 at pinned ones.
void free_difference(const State& state, std::vector<real>& y, const std::vector<real>& x, const std::vector<real>& p);

/// y = -x at free vertices and 0 at pinned ones.
void free_negative(const State& state, std::vector<real>& y, const std::vector<real>& x);

/// y = x at free vertices; pinned ones keep theirs.
void free_copy(const State& state, std::vector<real>& y, const std::vector<real>& x);

/// y = 0 at vertices that are asleep.
void clear_asleep(const State& state, std::vector<real>& y);

/// y = 0 at vertices that are pinned or asleep.
void clear_resting(const State& state, std::vector<real>& y);

/// Clears the planes, or the blocks of nine, of those items that take part. @param stride  items between two planes
void clear(std::vector<real>& field, int stride, const Items& items);
void clear(std::vector<block_real>& field, int stride, const Items& items);

/// Scales the blocks of nine, one per vertex, of those vertices that take part.
void scale_blocks(std::vector<block_real>& blocks, block_real factor, const Items& vertices);

/// Returns x . y over all entries, added up plane by plane.
double dot(const std::vector<real>& x, const std::vector<real>& y);

/// Returns x . y, added up vertex by vertex.
double dot(ConstPlanes x, ConstPlanes y);

/// The same of fields that are planes like state.pos.
double dot(const State& state, const std::vector<real>& x, const std::vector<real>& y);

/// Returns x . x over the vertices that take part.
double square(const State& state, const std::vector<real>& x, const Items& vertices);

/// Returns x . x over the vertices that are not awake. @param is_awake  per vertex
double square_asleep(const State& state, const std::vector<real>& x, const std::vector<char>& is_awake);

/// Returns the mass of the vertices that are not pinned [kg].
double free_mass(const State& state);

/// Returns the sum of m |x|^2 over the vertices that are not pinned.
double mass_square(const State& state, const std::vector<real>& x);

/// Returns the largest distance of a vertex in `a` from itself in `b`; both are planes like state.pos.
double largest_distance(const State& state, const std::vector<real>& a, const std::vector<real>& b);

/// Returns the largest |x|^2 of a vertex.
double largest_square(const State& state, const std::vector<real>& x);

/// Returns true if no position and no velocity is infinite or not a number.
bool is_finite(const State& state);

}  // namespace selvage
