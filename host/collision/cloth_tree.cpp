#include "host/collision/cloth_tree.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>

#include "host/collision/ccd.hpp"

namespace selvage {
namespace {

// Chosen by hand; not measured. All but the flatness affect speed only.
struct ClothTreeTuning {
    // Least s - e [1] of a subtree that a search skips, and of one that stays skipped without a new search. The second
    // is smaller, so that small changes of the shape cause no searches. Points of a skipped subtree that are within the
    // reach are at most reach / flatness apart at rest.
    static constexpr double skip_flatness = 0.4, keep_flatness = 0.25;
    static constexpr double slack_per_move = 0.02;     // slack of a corner over the length of its move [1]
    static constexpr int items_per_task = 512;         // corners, edges, faces or nodes
    static constexpr std::size_t search_pieces = 256;  // node pairs from which on a search runs in parallel
};

using Range = tbb::blocked_range<int>;

template <class Work>
void parallel(int count, const Work& work)
{
    tbb::parallel_for(Range(0, count, ClothTreeTuning::items_per_task), [&](const Range& range) {
        for (int i = range.begin(); i < range.end(); ++i) work(i);
    });
}

}  // namespace

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

// Computes the boxes in the moving frame, enlarged by half of the reach and by the slack. The slack of a corner grows
// with its move, since the next move will deviate by a fraction of it. Bodies that stand still need no slack, and their
// boxes are enlarged so that with those of the cloth they make up the bodies' reach.
void ClothTree::refit_boxes(bool bodies_move, bool bodies_too)
{
    parallel(bodies_too ? int(start_.size()) : particles_, [&](int k) {
        const bool still = k >= particles_ && !bodies_move;
        slack_of_[k] = still ? 0 : float(slack_ + ClothTreeTuning::slack_per_move * (end_[k] - start_[k]).norm());
        const float grown = slack_of_[k] + float(still ? body_reach_ - 0.5 * reach_ : 0.5 * reach_);
        for (int end = 0; end < 2; ++end) {
            const Vec3& x = (end == 0 ? start_ : end_)[k];
            const Sweep::Corner at{float(x[0]), float(x[1]), float(x[2]), 0.0f}, margin{grown, grown, grown, 0.0f};
            corner_box_[k].low[end] = at - margin;
            corner_box_[k].high[end] = at + margin;
        }
    });
    searched_start_ = start_;
    searched_end_ = end_;
    parallel(int(edges_.size()), [&](int e) {
        const auto& [a, b] = edges_[e];
        if (!bodies_too && a < 0) return;
        edge_box_[e] = corner_box_[slot(a)];
        edge_box_[e].add(corner_box_[slot(b)]);
    });
    parallel(int(surface_.faces.size()), [&](int f) {
        if (!bodies_too && surface_.faces[f][0] < 0) return;
        face_box_[f].clear();
        for (int corner : surface_.faces[f]) face_box_[f].add(corner_box_[slot(corner)]);
    });
    parallel(int(nodes_.size()), [&](int n) {
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
    return range.stretch_bound() > ClothTreeTuning::skip_flatness;
}

void ClothTree::refit_gradients()
{
    parallel(int(surface_.faces.size()), [&](int f) {
        const Face& face = surface_.faces[f];
        if (face[0] < 0) return;
        face_gradients_[f].clear();
        for (const std::vector<Vec3>* x : {&start_, &end_})
            add_gradient(face_gradients_[f], f, {(*x)[face[0]], (*x)[face[1]], (*x)[face[2]]});
    });
    parallel(int(nodes_.size()), [&](int n) {
        node_gradients_[n].clear();
        for (int k = 0; k < nodes_[n].near_count; ++k)
            node_gradients_[n].add(face_gradients_[near_[nodes_[n].first_near + k]]);
    });
    for (int n = int(nodes_.size()) - 1; n >= 0; --n)
        if (nodes_[n].right > 0 && nodes_[n].may_be_flat) {
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
    parallel(particles_, [&](int v) {
        for (int c = 0; c < 3; ++c) {
            start_[v][c] = from[c * stride + v] - mean_start[c];
            end_[v][c] = start_[v][c] + (move ? move[c * stride + v] - mean_move[c] : 0);
        }
    });
    if (!bodies.moves && bodies.version == body_version_) return;
    parallel(int(bodies.corners.size()), [&](int k) {
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

bool ClothTree::still_complete(const TreeBodies& bodies, double reach, double body_reach) const
{
    if (!valid_ || reach > reach_ || body_reach > body_reach_ || bodies.moves || bodies.version != body_version_)
        return false;
    const double start_part = fitted_fraction(start_), end_part = fitted_fraction(end_);
    return tbb::parallel_reduce(
        Range(0, particles_, 4096), true,
        [&](const Range& range, bool all) {
            for (int k = range.begin(); k < range.end() && all; ++k) {
                const Vec3 move = searched_end_[k] - searched_start_[k];
                const double deviation = std::max((start_[k] - searched_start_[k] - start_part * move).squaredNorm(),
                                                  (end_[k] - searched_start_[k] - end_part * move).squaredNorm());
                all = deviation <= double(slack_of_[k]) * slack_of_[k];
            }
            return all;
        },
        [](bool a, bool b) { return a && b; });
}

bool ClothTree::cover(const double* from, const double* move, int stride, const TreeBodies& bodies, double reach,
                      double body_reach)
{
    if (lies_flat(from, move, stride)) {
        const bool changed = !candidates_.empty();
        candidates_.clear();
        valid_ = false;
        ++counts_.flat_skipped;
        return changed;
    }
    set_frame(from, move, stride, bodies);
    refit_gradients();
    if (still_complete(bodies, reach, body_reach) && std::all_of(skipped_.begin(), skipped_.end(), [&](int n) {
            return is_flat(n, ClothTreeTuning::keep_flatness);
        })) {
        ++counts_.reused;
        return false;
    }
    const bool bodies_as_before =
        !bodies.moves && bodies.version == body_version_ && reach == reach_ && body_reach == body_reach_;
    reach_ = reach;
    body_reach_ = body_reach;
    refit_boxes(bodies.moves, !bodies_as_before);
    // The candidates along the move of a body are not those around it at rest, so the next call must search.
    body_version_ = bodies.moves ? -1 : bodies.version;
    search();
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
    parallel(int(surface_.faces.size()), [this](int f) {
        const Face& face = surface_.faces[f];
        face_sleeps_[f] = std::all_of(face.begin(), face.end(), [this](int c) { return sleeps(c); });
    });
    node_sleeps_.assign(nodes_.size(), 1);
    for (int n = int(nodes_.size()) - 1; n >= 0; --n)
        if (nodes_[n].right > 0)
            node_sleeps_[n] = node_sleeps_[n + 1] && node_sleeps_[nodes_[n].right];
        else
            for (int k = 0; k < nodes_[n].count; ++k)
                node_sleeps_[n] = node_sleeps_[n] && face_sleeps_[order_[nodes_[n].first + k]];
    std::copy_if(candidates_.begin(), candidates_.end(), std::back_inserter(asleep_),
                 [this](const PairCandidate& candidate) { return sleeps(candidate); });
}

// Adds the candidates of sleeping corners, which have not moved since these candidates were found.
void ClothTree::add_sleeping_candidates()
{
    const std::size_t first = candidates_.size();
    candidates_.insert(candidates_.end(), asleep_.begin(), asleep_.end());
    parallel(int(asleep_.size()), [&](int k) {
        PairCandidate& candidate = candidates_[first + std::size_t(k)];
        PairCorners x;
        for (int i = 0; i < 4; ++i) x[i] = start_[slot(candidate.corner[i])];
        candidate.distance = rounded_down(pair_distance(x, candidate.edges));
    });
}

void ClothTree::search()
{
    ++counts_.searches;
    candidates_.clear();
    skipped_.clear();
    if (nodes_.empty()) return;
    // One thread traverses the tree down to the first pieces. The pieces are then searched in parallel, and the results
    // are joined in the order of the pieces, so that they do not depend on the number of threads.
    std::vector<NodePair> pieces{{0, 0}}, stack;
    for (std::size_t next = 0; next < pieces.size() && pieces.size() - next < ClothTreeTuning::search_pieces; ++next) {
        stack.clear();
        visit(pieces[next], stack, skipped_, candidates_);
        pieces[next] = {-1, -1};
        pieces.insert(pieces.end(), stack.begin(), stack.end());
    }
    std::erase_if(pieces, [](const NodePair& piece) { return piece[0] < 0; });
    std::vector<std::vector<PairCandidate>> found(pieces.size());
    std::vector<std::vector<int>> skipped(pieces.size());
    tbb::parallel_for(std::size_t(0), pieces.size(), [&](std::size_t p) {
        std::vector<NodePair> open{pieces[p]};
        while (!open.empty()) {
            const NodePair pair = open.back();
            open.pop_back();
            visit(pair, open, skipped[p], found[p]);
        }
    });
    for (std::size_t p = 0; p < pieces.size(); ++p) {
        candidates_.insert(candidates_.end(), found[p].begin(), found[p].end());
        skipped_.insert(skipped_.end(), skipped[p].begin(), skipped[p].end());
    }
    counts_.flat_skipped += static_cast<long long>(skipped_.size());
    add_sleeping_candidates();
}

// Returns the faces of a leaf whose boxes meet a box.
ClothTree::FacesNear ClothTree::faces_near(const Node& leaf, const Sweep& box) const
{
    FacesNear result;
    for (int k = 0; k < leaf.count; ++k)
        if (const int face = order_[leaf.first + k]; face_box_[face].meets(box)) result.face[result.count++] = face;
    return result;
}

void ClothTree::visit(NodePair pair, std::vector<NodePair>& stack, std::vector<int>& skipped,
                      std::vector<PairCandidate>& found) const
{
    const auto [a, b] = pair;
    const Node &na = nodes_[a], &nb = nodes_[b];
    if (!is_awake_.empty() && node_sleeps_[a] && node_sleeps_[b]) return;
    if (a == b) {
        if (is_body(a)) return;
        if (is_flat(a, ClothTreeTuning::skip_flatness)) {
            skipped.push_back(a);
        } else if (na.right > 0) {
            stack.insert(stack.end(), {{a + 1, a + 1}, {na.right, na.right}, {a + 1, na.right}});
        } else {
            for (int i = 0; i < na.count; ++i)
                for (int j = i + 1; j < na.count; ++j) offer_pairs(order_[na.first + i], order_[na.first + j], found);
        }
        return;
    }
    if (!node_box_[a].meets(node_box_[b]) || (is_body(a) && is_body(b))) return;
    if (na.right == 0 && nb.right == 0) {
        const FacesNear of_b = faces_near(nb, node_box_[a]);
        for (int i = 0; i < na.count && of_b.count > 0; ++i) {
            const int face = order_[na.first + i];
            if (!face_box_[face].meets(node_box_[b])) continue;
            for (int j = 0; j < of_b.count; ++j) offer_pairs(face, of_b.face[j], found);
        }
    } else if (nb.right == 0 || (na.right > 0 && na.count >= nb.count)) {
        stack.insert(stack.end(), {{a + 1, b}, {na.right, b}});
    } else {
        stack.insert(stack.end(), {{a, b + 1}, {a, nb.right}});
    }
}

// Tests that the two primitives share no vertex, also after sewing.
bool ClothTree::may_touch(const PairCandidate& candidate) const
{
    const int first = candidate.edges ? 2 : 1;
    for (int i = 0; i < first; ++i)
        for (int j = first; j < 4; ++j) {
            const int a = candidate.corner[i], b = candidate.corner[j];
            if (a >= 0 && b >= 0 && surface_.group_of[a] == surface_.group_of[b]) return false;
        }
    return true;
}

// Keeps a pair whose distance, less the bound of its approach during the move, is within the reach and the slack.
void ClothTree::offer(const PairCandidate& candidate, std::vector<PairCandidate>& found) const
{
    if (!may_touch(candidate) || (!is_awake_.empty() && sleeps(candidate))) return;
    const int first = candidate.edges ? 2 : 1;
    PairCorners x, move;
    double slack[2] = {0, 0};
    for (int i = 0; i < 4; ++i) {
        const int at = slot(candidate.corner[i]);
        x[i] = start_[at];
        move[i] = end_[at] - start_[at];
        slack[i >= first] = std::max<double>(slack[i >= first], slack_of_[at]);
    }
    const double distance = pair_distance(x, candidate.edges);
    const bool body = std::min(candidate.corner[0], candidate.corner[3]) < 0;
    if (distance - pair_approach(move, candidate.edges) > (body ? body_reach_ : reach_) + slack[0] + slack[1]) return;
    found.push_back(candidate);
    found.back().distance = rounded_down(distance);
}

// Offers the pairs of primitives of two faces. A primitive is first tested against the whole other face.
void ClothTree::offer_pairs(int face_a, int face_b, std::vector<PairCandidate>& found) const
{
    if (!is_awake_.empty() && face_sleeps_[face_a] && face_sleeps_[face_b]) return;
    if (!face_box_[face_a].meets(face_box_[face_b])) return;
    const Face &a = surface_.faces[face_a], &b = surface_.faces[face_b];
    const std::array<int, 3>&edges_of_a = own_edges_[face_a], &edges_of_b = own_edges_[face_b];
    std::array<bool, 3> near_b;
    for (int l = 0; l < 3; ++l) {
        if ((owned_[face_b] >> l & 1) && corner_box_[slot(b[l])].meets(face_box_[face_a]))
            offer({{b[l], a[0], a[1], a[2]}, false}, found);
        near_b[l] = edges_of_b[l] >= 0 && edge_box_[edges_of_b[l]].meets(face_box_[face_a]);
    }
    for (int k = 0; k < 3; ++k) {
        if ((owned_[face_a] >> k & 1) && corner_box_[slot(a[k])].meets(face_box_[face_b]))
            offer({{a[k], b[0], b[1], b[2]}, false}, found);
        if (edges_of_a[k] < 0) continue;
        const Sweep& box_of_a = edge_box_[edges_of_a[k]];
        if (!box_of_a.meets(face_box_[face_b])) continue;
        for (int l = 0; l < 3; ++l)
            if (near_b[l] && box_of_a.meets(edge_box_[edges_of_b[l]]))
                offer({{a[k], a[(k + 1) % 3], b[l], b[(l + 1) % 3]}, true}, found);
    }
}

std::size_t ClothTree::bytes() const
{
    return nodes_.size() * (sizeof(Node) + sizeof(Sweep) + sizeof(Gradients)) +
           surface_.faces.size() * (sizeof(Face) + 3 * sizeof(Vec2) + sizeof(Sweep) + sizeof(Gradients) + 52) +
           edges_.size() * (sizeof(Sweep) + 2 * sizeof(int)) + near_.size() * sizeof(int) +
           start_.size() * (4 * sizeof(Vec3) + sizeof(Sweep) + sizeof(float)) +
           candidates_.capacity() * sizeof(PairCandidate);
}

// A mesh has three edges for two faces, and a leaf has from half of what it may hold to all of it.
std::size_t ClothTree::bytes_of(std::size_t faces, std::size_t corners)
{
    const std::size_t edges = 3 * faces / 2, leaves = 4 * faces / (3 * leaf_faces), nodes = 2 * leaves;
    const std::size_t of_face = sizeof(Face) + 3 * sizeof(Vec2) + sizeof(Sweep) + sizeof(Gradients) +
                                sizeof(std::array<double, 4>) + sizeof(std::array<int, 3>) + sizeof(int) + 2;
    return faces * of_face + edges * (sizeof(Sweep) + 2 * sizeof(int)) +
           nodes * (sizeof(Node) + sizeof(Sweep) + sizeof(Gradients)) +
           corners * (4 * sizeof(Vec3) + sizeof(Sweep) + sizeof(float) + sizeof(int));
}

}  // namespace selvage
