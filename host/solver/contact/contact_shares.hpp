#pragma once
#include <vector>

#include "host/solver/contact/ccd_filter.hpp"

namespace selvage {

/// Which part of the contact of two layers each pair stands for. Were all pairs of a place to count alike, a vertex
/// would be pressed on by every triangle around the one that it lies on, and pushed away from them: off the edges and
/// vertices of another layer, and off its rim.
///
/// Only pairs of different pieces of cloth are shared out, and those whole where the other one is folded: shares follow
/// the place from one of Newton's iterations to the next and no energy has them in it. Tightly folded cloth, as in
/// stress_fold, does not come to rest with them.
class ContactShares {
public:
    struct Share {
        double part = 1;     ///< Of the pair's area [1].
        bool plane = false;  ///< The vertex is above the face or little beyond it: it meets the plane of the face.
    };

    /// @param faces  of the cloth, corners as particles   @param piece  that each particle is of
    ContactShares(const std::vector<Face>& faces, std::vector<int> piece);

    /// Of pairs in ascending order of their keys, which hold all that a vertex has in common with a layer. Pairs with
    /// bodies and of one piece count whole. @param at  where the corners are
    std::vector<Share> of(const std::vector<PairCandidate>& pairs, const StraightStep& at) const;

    std::size_t bytes() const
    {
        return faces_.capacity() * sizeof(Face) +
               (piece_.capacity() + first_.capacity() + around_.capacity()) * sizeof(int) + on_rim_.capacity();
    }

private:
    struct Place {            // where a vertex is to a face
        double distance = 0;  // [m]
        double cosine = 1;    // of the angle between the way from the nearest point and the normal of the face
        bool inside = true;   // above the face
        bool rim = false;     // nearest to the rim of the layer
    };
    Place place_of(const PairCandidate& pair, const StraightStep& at) const;
    bool is_rim(int a, int b) const;
    bool is_shared(const PairCandidate& pair) const;
    Share share_of(const std::vector<PairCandidate>& pairs, const std::vector<Place>& places, int p,
                   const StraightStep& at) const;

    std::vector<Face> faces_;
    std::vector<int> piece_;           // of each particle
    std::vector<int> first_, around_;  // the faces around each particle
    std::vector<char> on_rim_;         // per particle
};

}  // namespace selvage
