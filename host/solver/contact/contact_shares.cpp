#include "host/solver/contact/contact_shares.hpp"

#include <algorithm>
#include <cmath>

#include "host/parallel/launch.hpp"
#include "host/solver/contact/contact_tuning.hpp"

namespace selvage {
namespace {

using Tuning = ContactTuning;

bool has_corner(const Face& face, int v) { return face[0] == v || face[1] == v || face[2] == v; }

// From 0 to 1 between two values.
double smooth_step(double x, double from, double to)
{
    const double s = std::clamp((x - from) / (to - from), 0.0, 1.0);
    return s * s * (3 - 2 * s);
}

// Whether two pairs are of one vertex, with faces that have a corner in common.
bool are_neighbours(const PairCandidate& a, const PairCandidate& b)
{
    return std::find_first_of(a.corner.begin() + 1, a.corner.end(), b.corner.begin() + 1, b.corner.end()) !=
           a.corner.end();
}

Vec3 face_normal(const PairCorners& x) { return (x[2] - x[1]).cross(x[3] - x[1]).normalized(); }

// A layer's rim holds what is above it and a little beyond as its inside does. What is beside it is pushed aside.
ContactShares::Share at_rim(double cosine)
{
    if (cosine > Tuning::rim_slant)
        return {std::max(Tuning::rim_least, smooth_step(cosine, Tuning::rim_slant, Tuning::above)), true};
    return {std::max(Tuning::rim_least, 1 - smooth_step(cosine, Tuning::rim_beside, Tuning::rim_slant)), false};
}

// Edges that meet at an end of one of them are met as a vertex by faces.
double share_of_edges(const PairCorners& x)
{
    const pair_weights p = closest_weights(x, true);
    return smooth_step(std::min({p.w[0], p.w[1], -p.w[2], -p.w[3]}), 0, Tuning::edge_end);
}

}  // namespace

ContactShares::ContactShares(const std::vector<Face>& faces, std::vector<int> piece)
    : faces_(faces), piece_(std::move(piece)), first_(piece_.size() + 1), on_rim_(piece_.size())
{
    for (const Face& f : faces_)
        for (int v : f) ++first_[std::size_t(v) + 1];
    for (std::size_t v = 1; v < first_.size(); ++v) first_[v] += first_[v - 1];
    around_.resize(3 * faces_.size());
    std::vector<int> next(first_.begin(), first_.end() - 1);
    for (int f = 0; f < int(faces_.size()); ++f)
        for (int v : faces_[f]) around_[next[v]++] = f;
    for (const Face& f : faces_)
        for (int k = 0; k < 3; ++k)
            if (is_rim(f[k], f[(k + 1) % 3])) on_rim_[f[k]] = on_rim_[f[(k + 1) % 3]] = 1;
}

// Whether an edge has one face only.
bool ContactShares::is_rim(int a, int b) const
{
    return std::count_if(around_.begin() + first_[a], around_.begin() + first_[a + 1],
                         [&](int face) { return has_corner(faces_[face], b); }) == 1;
}

ContactShares::Place ContactShares::place_of(const PairCandidate& pair, const StraightStep& at) const
{
    const PairCorners x = at.start_of(pair);
    const pair_weights weights = closest_weights(x, false);
    std::array<int, 3> on{};  // the corners of what is nearest
    int corners = 0;
    Vec3 way = x[0];
    for (int i = 1; i < 4; ++i) {
        if (weights.w[i] < 0) on[corners++] = pair.corner[i];
        way += weights.w[i] * x[i];
    }
    Place place;
    place.distance = way.norm();
    place.inside = corners == 3;
    if (place.inside) return place;
    place.cosine = std::abs(face_normal(x).dot(way)) / std::max(place.distance, 1e-30);
    place.rim = on_rim_[on[0]] && (corners == 1 || is_rim(on[0], on[1]));
    return place;
}

bool ContactShares::is_shared(const PairCandidate& pair) const
{
    return !has_body(pair) && piece_[pair.corner[0]] != piece_[pair.corner[3]];
}

// Those faces that are nearly as near as the nearest have a vertex between them, so that it is passed on smoothly.
ContactShares::Share ContactShares::share_of(const std::vector<PairCandidate>& pairs, const std::vector<Place>& places,
                                             int p, const StraightStep& at) const
{
    const auto of_vertex = [&](int q) {
        return q >= 0 && q < int(pairs.size()) && !pairs[q].edges && pairs[q].corner[0] == pairs[p].corner[0];
    };
    int first = p, end = p + 1;
    while (of_vertex(first - 1)) --first;
    while (of_vertex(end)) ++end;
    double nearest = places[p].distance, all = 0, flatness = 1;  // of those that take part
    for (int q = first; q < end; ++q)
        if (are_neighbours(pairs[p], pairs[q])) nearest = std::min(nearest, places[q].distance);
    const auto weight = [&](int q) {
        return 1 - smooth_step(places[q].distance, nearest, (1 + Tuning::nearly_as_near) * nearest);
    };
    const Vec3 normal = face_normal(at.start_of(pairs[p]));
    for (int q = first; q < end; ++q) {
        if (!are_neighbours(pairs[p], pairs[q]) || weight(q) == 0) continue;
        all += weight(q);
        flatness = std::min(flatness, std::abs(normal.dot(face_normal(at.start_of(pairs[q])))));
    }
    const bool beyond = !places[p].inside && places[p].cosine > Tuning::above && flatness > Tuning::flat;
    Share share = places[p].rim ? at_rim(places[p].cosine) : Share{1, beyond};
    const double shared = smooth_step(flatness, Tuning::folded, Tuning::flat);
    share.part *= shared * weight(p) / all + 1 - shared;
    return share;
}

std::vector<ContactShares::Share> ContactShares::of(const std::vector<PairCandidate>& pairs,
                                                    const StraightStep& at) const
{
    std::vector<Share> shares(pairs.size());
    std::vector<Place> places(pairs.size());
    for_each_item(int(pairs.size()), [&, this](int p) {
        if (!pairs[p].edges && is_shared(pairs[p])) places[p] = place_of(pairs[p], at);
    });
    for_each_item(int(pairs.size()), [&, this](int p) {
        if (!is_shared(pairs[p])) return;
        if (pairs[p].edges)
            shares[p].part = share_of_edges(at.start_of(pairs[p]));
        else
            shares[p] = share_of(pairs, places, p, at);
    });
    return shares;
}

}  // namespace selvage
