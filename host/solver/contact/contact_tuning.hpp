#pragma once

namespace selvage {

/// The tuned constants of contact between cloth and cloth, and of faces and edges of the cloth with bodies. "By hand"
/// means that the value has not been measured against others. Units: [1], or of the gap at which the pair's contact
/// sets in.
struct ContactTuning {
    // What the CCD step filter leaves: of its room above the floor, a pair keeps a share or the scarce room, whichever
    // is more, and nearly all of a room that is scarce already.

    // [gap] No pair comes as near. The barrier has its pole there (kernels/terms/cloth_contact.h), so that positions
    // rounded to float do not touch.
    static constexpr double floor = 5e-3;
    static constexpr double kept = 0.1;  // [1] share that a Newton step leaves; by hand
    // [1] Share that a step of bodies and pins leaves: more, since the cloth makes way in Newton steps in between.
    // By hand.
    static constexpr double held_kept = 0.5;
    static constexpr double scarce = 1e-6;         // [gap] far above the rounding of doubles
    static constexpr double held_scarce = 1e-4;    // [gap] for steps of bodies and pins; by hand
    static constexpr double kept_of_scarce = 0.9;  // [1] near 1, so that many steps do not use the room up; by hand
    // Rounds in which steps of single particles are shortened before the whole step is. Each costs a refresh of the
    // candidates. By hand.
    static constexpr int local_rounds = 4;
    // [edge length] Slack of the tree's boxes: `bench broad-phase`, rows "own" against "own, no slack", columns step
    // ms.
    static constexpr double tree_slack = 0.1;

    // Pairs.

    // Where contact of cloth with cloth sets in at most, of the mean edge of its piece and of the distance at rest of
    // the two sides: neighbours in a panel must not press on each other, also where it is bent and compressed. By hand.
    static constexpr double gap_of_edge = 0.4, gap_of_rest = 0.8;

    // [gap] Where edges and corners of bodies press on the cloth. Further out the contact planes of vertices do, which
    // cost less; by hand.
    static constexpr double body_gap = 0.25;
    // [1] Edges that cross at a smaller sine count less: the closest points of parallel edges jump. By hand.
    static constexpr double parallel_sine = 0.1;

    // ContactShares, by hand on three cards that lie on each other without friction.
    static constexpr double nearly_as_near = 0.06;  // [1] faces further away by this share take no part
    // [1] Cosines of the largest angle between faces that take part: where their planes are met beyond their edges as
    // well, and where pairs count whole again. With planes in folds stress_needles does not come to rest.
    static constexpr double flat = 0.9962, folded = 0.966;
    // [edge] Near an end edges count less. At 0.1 the layers of stress_stack do not come to rest.
    static constexpr double edge_end = 0.02;
    // [1] Cosines of the way to a vertex with the normal of a face that it is beyond: above it; at a rim, where the
    // share of the face's plane has faded to the least, and where that of what is beside begins.
    static constexpr double above = 0.906, rim_slant = 0.707, rim_beside = 0.423;
    static constexpr double rim_least = 1e-3;  // [1] so that there is a barrier everywhere

    // Steps of pins. Below this share [1] the particles that follow pins are shortened one by one, and the pins then go
    // on by `most_ahead` [1] at most. Folds of the scene stress_ring were torn open without these limits.
    static constexpr float jammed = 0.05f;
    static constexpr float most_ahead = 0.25f;
};

}  // namespace selvage
