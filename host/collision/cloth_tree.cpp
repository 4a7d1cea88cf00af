#include "host/collision/cloth_tree.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>

#include <tbb/parallel_reduce.h>

#include "host/collision/ccd.hpp"
#include "host/collision/cloth_tree_tuning.hpp"

namespace selvage {

using Tuning = ClothTreeTuning;
using Range = tbb::blocked_range<int>;

void ClothTree::Sweep::clear()
{
    for (int end = 0; end < 2; ++end) {
        low[end].fill(std::numeric_limits<float>::infinity());
        high[end].fill(-std::numeric_limits<float>::infinity());
    }
}

void ClothTree::Sweep::add(const Sweep& other)
{
    for (int end = 0; end < 2; ++end) {
        low[end] = low[end].min(other.low[end]);
        high[end] = high[end].max(other.high[end]);
    }
}

void ClothTree::Gradients::clear()
{
    low.fill(std::numeric_limits<float>::infinity());
    high.fill(-std::numeric_limits<float>::infinity());
}

void ClothTree::Gradients::add(const Gradients& other)
{
    for (int c = 0; c < 6; ++c) {
        low[c] = std::min(low[c], other.low[c]);
        high[c] = std::max(high[c], other.high[c]);
    }
}

double ClothTree::Gradients::stretch_bound() const
{
    double middle[6], squared_spread = 0;
    for (int c = 0; c < 6; ++c) {
        middle[c] = 0.5 * (double(low[c]) + double(high[c]));
        squared_spread += std::pow(0.5 * (double(high[c]) - double(low[c])), 2);
    }
    const double uu = middle[0] * middle[0] + middle[1] * middle[1] + middle[2] * middle[2];
    const double vv = middle[3] * middle[3] + middle[4] * middle[4] + middle[5] * middle[5];
    const double uv = middle[0] * middle[3] + middle[1] * middle[4] + middle[2] * middle[5];
    const double smaller = 0.5 * (uu + vv) - std::hypot(0.5 * (uu - vv), uv);
    return std::sqrt(std::max(smaller, 0.0)) - std::sqrt(squared_spread);
}

// Computes the boxes of the searched moves, enlarged by half of the reach and by the slack. Bodies that stand still
// need no slack, and their boxes are enlarged so that with those of the cloth they make up the bodies' reach.
void ClothTree::refit_boxes(bool bodies_move, bool bodies_too)
{
    for_each_part(bodies_too ? int(start_.size()) : particles_, [&](int k) {
        const bool still = k >= particles_ && !bodies_move;
        const float grown = slack_of_[k] + float(still ? body_reach_ - 0.5 * reach_ : 0.5 * reach_);
        for (int end = 0; end < 2; ++end) {
            const Vec3& x = (end == 0 ? searched_start_ : searched_end_)[k];
            const Sweep::Corner at{float(x[0]), float(x[1]), float(x[2]), 0.0f}, margin{grown, grown, grown, 0.0f};
            corner_box_[k].low[end] = at - margin;
            corner_box_[k].high[end] = at + margin;
        }
    });
    for_each_part(int(edges_.size()), [&](int e) {
        const auto& [a, b] = edges_[e];
        if (!bodies_too && a < 0) return;
        edge_box_[e] = corner_box_[slot(a)];
        edge_box_[e].add(corner_box_[slot(b)]);
    });
    for_each_part(int(surface_.faces.size()), [&](int f) {
        if (!bodies_too && surface_.faces[f][0] < 0) return;
        face_box_[f].clear();
        for (int corner : surface_.faces[f]) face_box_[f].add(corner_box_[slot(corner)]);
    });
    for_each_part(int(nodes_.size()), [&](int n) {
        if (!bodies_too && is_body(n)) return;
        node_box_[n].clear();
        if (nodes_[n].right > 0) return;
        for (int k = 0; k < nodes_[n].count; ++k) node_box_[n].add(face_box_[order_[nodes_[n].first + k]]);
    });
    for (int n = int(nodes_.size()) - 1; n >= 0; --n)
        if (nodes_[n].right > 0 && (bodies_too || !is_body(n))) {
            node_box_[n].add(node_box_[n + 1]);
            node_box_[n].add(node_box_[nodes_[n].right]);
        }
}

// Extends the range by the deformation gradient of a face. @param corners  positions of its corners [m]
void ClothTree::add_gradient(Gradients& range, int face, const std::array<Vec3, 3>& corners) const
{
    const std::array<double, 4>& w = rest_inverse_[face];
    const Vec3 e1 = corners[1] - corners[0], e2 = corners[2] - corners[0];
    const Vec3 weft = w[0] * e1 + w[1] * e2, warp = w[2] * e1 + w[3] * e2;
    Gradients one;
    for (int c = 0; c < 3; ++c) {
        one.low[c] = one.high[c] = float(weft[c]);
        one.low[3 + c] = one.high[3 + c] = float(warp[c]);
    }
    range.add(one);
}

// Tests whether the whole surface is one panel that is too flat to meet itself. This needs only
// the deformation gradients.
bool ClothTree::lies_flat(const double* from, const double* move, int stride) const
{
    if (surface_.patches.size() != 1 || nodes_.empty() || !nodes_[0].may_be_flat) return false;
    Gradients none;
    none.clear();
    const Gradients range = tbb::parallel_reduce(
        Range(0, int(surface_.faces.size()), 4096), none,
        [&](const Range& part, Gradients sum) {
            for (int f = part.begin(); f < part.end(); ++f) {
                std::array<Vec3, 3> at;
                for (int end = 0; end < (move ? 2 : 1); ++end) {
                    for (int k = 0; k < 3; ++k)
                        for (int c = 0; c < 3; ++c) {
                            const int i = c * stride + surface_.faces[f][k];
                            at[k][c] = from[i] + (end == 1 ? move[i] : 0);
                        }
                    add_gradient(sum, f, at);
                }
            }
            return sum;
        },
        [](Gradients a, const Gradients& b) {
            a.add(b);
            return a;
        });
    return range.stretch_bound() > Tuning::skip_flatness;
}

// @param skipped_only  only those of the skipped subtrees, which are all that tells whether a search is needed
void ClothTree::refit_gradients(bool skipped_only)
{
    if (skipped_only && skipped_.empty()) return;
    const auto is_asked = [&](const std::vector<char>& flags, int k) { return !skipped_only || flags[k]; };
    for_each_part(int(surface_.faces.size()), [&](int f) {
        const Face& face = surface_.faces[f];
        if (face[0] < 0 || !is_asked(near_skipped_, f)) return;
        face_gradients_[f].clear();
        for (const std::vector<Vec3>* x : {&start_, &end_})
            add_gradient(face_gradients_[f], f, {(*x)[face[0]], (*x)[face[1]], (*x)[face[2]]});
    });
    for_each_part(int(nodes_.size()), [&](int n) {
        if (!is_asked(in_skipped_, n)) return;
        node_gradients_[n].clear();
        for (int k = 0; k < nodes_[n].near_count; ++k)
            node_gradients_[n].add(face_gradients_[near_[nodes_[n].first_near + k]]);
    });
    for (int n = int(nodes_.size()) - 1; n >= 0; --n)
        if (nodes_[n].right > 0 && nodes_[n].may_be_flat && is_asked(in_skipped_, n)) {
            node_gradients_[n].add(node_gradients_[n + 1]);
            node_gradients_[n].add(node_gradients_[nodes_[n].right]);
        }
}

// Without bodies the frame moves with the mean of the cloth, since a translation of the whole cloth
// changes no distance.
void ClothTree::set_frame(const double* from, const double* move, int stride, const TreeBodies& bodies)
{
    Vec3 mean_start = Vec3::Zero(), mean_move = Vec3::Zero();
    if (bodies.corners.empty()) {
        for (int c = 0; c < 3; ++c) {
            double sum = 0, moves = 0;
            for (int v = 0; v < particles_; ++v) {
                sum += from[c * stride + v];
                if (move) moves += move[c * stride + v];
            }
            mean_start[c] = sum / particles_;
            mean_move[c] = moves / particles_;
        }
    }
    for_each_part(particles_, [&](int v) {
        for (int c = 0; c < 3; ++c) {
            start_[v][c] = from[c * stride + v] - mean_start[c];
            end_[v][c] = start_[v][c] + (move ? move[c * stride + v] - mean_move[c] : 0);
        }
    });
    if (!bodies.moves && bodies.version == body_version_) return;
    for_each_part(int(bodies.corners.size()), [&](int k) {
        start_[particles_ + k] = bodies.corners[k];
        end_[particles_ + k] = bodies.moves ? Vec3(bodies.corners[k] + (*bodies.moves)[k]) : bodies.corners[k];
    });
}

// Returns the fraction of the searched move after which the corners are closest to the given positions,
// by least squares.
double ClothTree::fitted_fraction(const std::vector<Vec3>& at) const
{
    using Sums = std::array<double, 2>;
    const Sums sums = tbb::parallel_deterministic_reduce(
        Range(0, particles_, 4096), Sums{},
        [&](const Range& range, Sums sum) {
            for (int k = range.begin(); k < range.end(); ++k) {
                const Vec3 move = searched_end_[k] - searched_start_[k];
                sum[0] += move.dot(at[k] - searched_start_[k]);
                sum[1] += move.squaredNorm();
            }
            return sum;
        },
        [](const Sums& a, const Sums& b) {
            return Sums{a[0] + b[0], a[1] + b[1]};
        });
    return sums[1] > 0 ? std::clamp(sums[0] / sums[1], 0.0, 1.0) : 0;
}

// The move of a corner in this call becomes its searched move. Its slack grows with it, since the next move will
// deviate by a fraction of it.
void ClothTree::search_anew(int k, bool still)
{
    searched_start_[k] = start_[k];
    searched_end_[k] = end_[k];
    slack_of_[k] = still ? 0 : float(slack_ + Tuning::slack_per_move * (end_[k] - start_[k]).norm());
}

// Marks the corners whose pairs are not known for the present move: those that leave their searched moves, and all of
// subtrees that were skipped and are flat no more. If they are not too many, sets the searched moves: new ones for
// those that left theirs, and for the others the part of the old ones that they make now.
ClothTree::Unknown ClothTree::mark_unknown()
{
    const double start_part = fitted_fraction(start_), end_part = fitted_fraction(end_);
    marks_.resize(std::size_t(particles_));
    for_each_part(particles_, [&](int k) {
        const Vec3 move = searched_end_[k] - searched_start_[k];
        const double deviation = std::max((start_[k] - searched_start_[k] - start_part * move).squaredNorm(),
                                          (end_[k] - searched_start_[k] - end_part * move).squaredNorm());
        marks_[k] = deviation <= double(slack_of_[k]) * slack_of_[k] ? 0 : deviates;
    });
    const auto bent = std::stable_partition(skipped_.begin(), skipped_.end(),
                                            [&](int n) { return is_flat(n, Tuning::keep_flatness); });
    for (auto n = bent; n != skipped_.end(); ++n)
        for (int k = nodes_[*n].first; k < nodes_[*n].first + nodes_[*n].count; ++k)
            for (int corner : surface_.faces[order_[k]]) marks_[corner] |= was_skipped;
    skipped_.erase(bent, skipped_.end());
    const auto marked = particles_ - std::count(marks_.begin(), marks_.end(), 0);
    if (marked == 0) return Unknown::nothing;
    if (double(marked) > Tuning::most_marked * particles_ || ++partial_since_ > Tuning::most_partial)
        return Unknown::all;
    for_each_part(particles_, [&](int k) {
        if (marks_[k] & deviates) {
            search_anew(k, false);
            return;
        }
        const Vec3 from = searched_start_[k], move = searched_end_[k] - from;
        searched_start_[k] = from + start_part * move;
        searched_end_[k] = from + end_part * move;
    });
    return Unknown::marked;
}

bool ClothTree::cover(const double* from, const double* move, int stride, const TreeBodies& bodies, double reach,
                      double body_reach)
{
    if (!valid_ && lies_flat(from, move, stride)) {
        const bool changed = !candidates_.empty();
        candidates_.clear();
        kept_from_.clear();
        ++counts_.flat_skipped;
        return changed;
    }
    set_frame(from, move, stride, bodies);
    const bool bodies_as_before = !bodies.moves && bodies.version == body_version_;
    const bool comparable = valid_ && reach <= reach_ && body_reach <= body_reach_ && bodies_as_before;
    if (comparable) refit_gradients(true);
    const Unknown unknown = comparable ? mark_unknown() : Unknown::all;
    if (unknown == Unknown::nothing) {
        ++counts_.reused;
        return false;
    }
    if (unknown == Unknown::marked) {
        refit_boxes(false, false);
        search_marked();
        return true;
    }
    const bool bodies_too = !(bodies_as_before && reach == reach_ && body_reach == body_reach_);
    reach_ = reach;
    body_reach_ = body_reach;
    for_each_part(int(start_.size()), [&](int k) { search_anew(k, k >= particles_ && !bodies.moves); });
    refit_boxes(bodies.moves, bodies_too);
    refit_gradients(false);
    // The candidates along the move of a body are not those around it at rest, so the next call must search.
    body_version_ = bodies.moves ? -1 : bodies.version;
    search_all();
    valid_ = true;
    return true;
}

void ClothTree::let_sleep(const std::vector<char>* is_awake)
{
    valid_ = false;
    asleep_.clear();
    if (!is_awake) {
        is_awake_.clear();
        return;
    }
    is_awake_ = *is_awake;
    face_sleeps_.resize(surface_.faces.size());
    for_each_part(int(surface_.faces.size()), [this](int f) {
        const Face& face = surface_.faces[f];
        face_sleeps_[f] = std::all_of(face.begin(), face.end(), [this](int c) { return sleeps(c); });
    });
    flag_nodes(face_sleeps_, true, node_sleeps_);
    std::copy_if(candidates_.begin(), candidates_.end(), std::back_inserter(asleep_),
                 [this](const PairCandidate& candidate) { return sleeps(candidate); });
}

// Adds the candidates of sleeping corners, which have not moved since these candidates were found.
void ClothTree::add_sleeping_candidates()
{
    const std::size_t first = candidates_.size();
    candidates_.insert(candidates_.end(), asleep_.begin(), asleep_.end());
    for_each_part(int(asleep_.size()), [&](int k) {
        PairCandidate& candidate = candidates_[first + std::size_t(k)];
        PairCorners x;
        for (int i = 0; i < 4; ++i) x[i] = start_[slot(candidate.corner[i])];
        candidate.distance = rounded_down(pair_distance(x, candidate.edges));
    });
}

std::size_t ClothTree::bytes() const
{
    return nodes_.size() * (sizeof(Node) + sizeof(Sweep) + sizeof(Gradients)) +
           surface_.faces.size() * (sizeof(Face) + 3 * sizeof(Vec2) + sizeof(Sweep) + sizeof(Gradients) + 52) +
           edges_.size() * (sizeof(Sweep) + 2 * sizeof(int)) + near_.size() * sizeof(int) +
           start_.size() * (4 * sizeof(Vec3) + sizeof(Sweep) + sizeof(float)) + marks_.size() + face_marks_.size() +
           node_marks_.size() + near_skipped_.size() + in_skipped_.size() + node_skipped_.size() +
           kept_from_.capacity() * sizeof(int) + candidates_.capacity() * sizeof(PairCandidate);
}

// A mesh has three edges for two faces, and a leaf has from half of what it may hold to all of it.
std::size_t ClothTree::bytes_of(std::size_t faces, std::size_t corners)
{
    const std::size_t edges = 3 * faces / 2, leaves = 4 * faces / (3 * leaf_faces), nodes = 2 * leaves;
    const std::size_t of_face = sizeof(Face) + 3 * sizeof(Vec2) + sizeof(Sweep) + sizeof(Gradients) +
                                sizeof(std::array<double, 4>) + sizeof(std::array<int, 3>) + sizeof(int) + 3;
    return faces * of_face + edges * (sizeof(Sweep) + 2 * sizeof(int)) +
           nodes * (sizeof(Node) + sizeof(Sweep) + sizeof(Gradients) + 2) +
           corners * (4 * sizeof(Vec3) + sizeof(Sweep) + sizeof(float) + sizeof(int) + 1);
}

}  // namespace selvage
