// Traversals of a ClothTree.
#include <algorithm>

#include <tbb/parallel_for.h>

#include "host/collision/ccd.hpp"
#include "host/collision/cloth_tree.hpp"
#include "host/collision/cloth_tree_tuning.hpp"

namespace selvage {

void ClothTree::search_all()
{
    partial_ = false;
    partial_since_ = 0;
    kept_from_.clear();
    candidates_.clear();
    skipped_.clear();
    traverse(counts_.whole);
    note_skipped();
    add_sleeping_candidates();
}

// Replaces the candidates that have a marked corner. Those that sleep are kept, since nothing looks for them.
void ClothTree::search_marked()
{
    partial_ = true;
    kept_from_.clear();
    for (int k = 0; k < int(candidates_.size()); ++k) {
        if (is_marked(candidates_[k]) && (is_awake_.empty() || !sleeps(candidates_[k]))) continue;
        candidates_[kept_from_.size()] = candidates_[k];
        kept_from_.push_back(k);
    }
    candidates_.resize(kept_from_.size());
    face_marks_.resize(surface_.faces.size());
    for_each_part(int(surface_.faces.size()), [this](int f) {
        const Face& face = surface_.faces[f];
        face_marks_[f] = std::any_of(face.begin(), face.end(), [this](int c) { return is_marked(c); });
    });
    flag_nodes(face_marks_, false, node_marks_);
    node_skipped_.assign(nodes_.size(), 0);
    for (int n : skipped_) node_skipped_[n] = 1;
    traverse(counts_.partial);
    note_skipped();
}

void ClothTree::flag_nodes(const std::vector<char>& faces, bool all, std::vector<char>& nodes) const
{
    nodes.assign(nodes_.size(), all);
    const auto add = [&](int n, char flag) { nodes[n] = all ? nodes[n] && flag : nodes[n] || flag; };
    for (int n = int(nodes_.size()) - 1; n >= 0; --n) {  // children are behind their parents
        if (nodes_[n].right > 0) {
            add(n, nodes[n + 1]);
            add(n, nodes[nodes_[n].right]);
        } else {
            for (int k = 0; k < nodes_[n].count; ++k) add(n, faces[order_[nodes_[n].first + k]]);
        }
    }
}

void ClothTree::note_skipped()
{
    in_skipped_.assign(nodes_.size(), 0);
    near_skipped_.assign(surface_.faces.size(), 0);
    for (int n : skipped_) in_skipped_[n] = 1;
    for (std::size_t n = 0; n < nodes_.size(); ++n) {
        if (!in_skipped_[n]) continue;
        if (nodes_[n].right > 0) in_skipped_[n + 1] = in_skipped_[nodes_[n].right] = 1;
        for (int k = 0; k < nodes_[n].near_count; ++k) near_skipped_[near_[nodes_[n].first_near + k]] = 1;
    }
}

// Adds what is found to the candidates and to the skipped subtrees.
void ClothTree::traverse(SearchCounts& counts)
{
    if (nodes_.empty()) return;
    // One thread traverses the tree down to the first pieces. The pieces are then searched in parallel, and the results
    // are joined in the order of the pieces, so that they do not depend on the number of threads.
    const Stopwatch watch;
    std::vector<NodePair> pieces{{0, 0}}, stack;
    Findings above;
    for (std::size_t next = 0; next < pieces.size() && pieces.size() - next < ClothTreeTuning::search_pieces; ++next) {
        stack.clear();
        visit(pieces[next], stack, above);
        pieces[next] = {-1, -1};
        pieces.insert(pieces.end(), stack.begin(), stack.end());
    }
    std::erase_if(pieces, [](const NodePair& piece) { return piece[0] < 0; });
    std::vector<Findings> found(pieces.size() + 1);
    found[0] = std::move(above);
    tbb::parallel_for(std::size_t(0), pieces.size(), [&](std::size_t p) {
        std::vector<NodePair> open{pieces[p]};
        while (!open.empty()) {
            const NodePair pair = open.back();
            open.pop_back();
            visit(pair, open, found[p + 1]);
        }
    });
    ++counts.searches;
    for (const Findings& piece : found) {
        candidates_.insert(candidates_.end(), piece.candidates.begin(), piece.candidates.end());
        skipped_.insert(skipped_.end(), piece.skipped.begin(), piece.skipped.end());
        counts.measured += piece.measured;
        counts_.flat_skipped += static_cast<long long>(piece.skipped.size());
    }
    counts.spent = counts.spent + watch.spent();
}

// Returns the faces of a leaf whose boxes meet a box.
ClothTree::FacesNear ClothTree::faces_near(const Node& leaf, const Sweep& box) const
{
    FacesNear result;
    for (int k = 0; k < leaf.count; ++k)
        if (const int face = order_[leaf.first + k]; face_box_[face].meets(box)) result.face[result.count++] = face;
    return result;
}

void ClothTree::visit(NodePair pair, std::vector<NodePair>& stack, Findings& found) const
{
    const auto [a, b] = pair;
    const Node &na = nodes_[a], &nb = nodes_[b];
    if (!is_awake_.empty() && node_sleeps_[a] && node_sleeps_[b]) return;
    if (partial_ && !node_marks_[a] && !node_marks_[b]) return;
    if (a == b) {
        if (is_body(a) || (partial_ && node_skipped_[a])) return;
        if ((!partial_ || in_skipped_[a]) && is_flat(a, ClothTreeTuning::skip_flatness)) {
            found.skipped.push_back(a);
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

// Keeps a pair whose distance, less the bound of its approach during the searched move, is within the reach and the
// slack.
void ClothTree::offer(const PairCandidate& candidate, Findings& found) const
{
    if (partial_ && !is_marked(candidate)) return;
    if (!may_touch(candidate) || (!is_awake_.empty() && sleeps(candidate))) return;
    const int first = candidate.edges ? 2 : 1;
    PairCorners x, move;
    double slack[2] = {0, 0};
    for (int i = 0; i < 4; ++i) {
        const int at = slot(candidate.corner[i]);
        x[i] = searched_start_[at];
        move[i] = searched_end_[at] - searched_start_[at];
        slack[i >= first] = std::max<double>(slack[i >= first], slack_of_[at]);
    }
    ++found.measured;
    const double distance = pair_distance(x, candidate.edges);
    const bool body = std::min(candidate.corner[0], candidate.corner[3]) < 0;
    if (distance - pair_approach(move, candidate.edges) > (body ? body_reach_ : reach_) + slack[0] + slack[1]) return;
    found.candidates.push_back(candidate);
    // In a partial search the corners that are not marked start somewhere within their slack.
    found.candidates.back().distance = rounded_down(partial_ ? distance - slack[0] - slack[1] : distance);
}

// Offers the pairs of primitives of two faces. A primitive is first tested against the whole other face.
void ClothTree::offer_pairs(int face_a, int face_b, Findings& found) const
{
    if (!is_awake_.empty() && face_sleeps_[face_a] && face_sleeps_[face_b]) return;
    if (partial_ && !face_marks_[face_a] && !face_marks_[face_b]) return;
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

}  // namespace selvage
