#pragma once
#include <array>
#include <vector>

#include "host/model/cloth_model.hpp"
#include "host/solver/state/topology.hpp"

namespace selvage {

/// A face unfolded into the rest plane of another.
struct PlacedFace {
    int face;
    Mat2 map;     ///< From the face's own panel coordinates to the base face's: a rotation or a reflection.
    double sign;  ///< 1 if its outside is the base face's, -1 if its panel was sewn on from the other side.
};

/// The rest geometry that plate bending is derived from: faces in their panels, and how hinges join them.
/// Edge k of a face lies opposite corner k. "Row" means three numbers that give an angle from a surface's second
/// derivatives (xx, yy, xy): z = 1/2 x^T S x has the side angle m . (Sxx, Syy, Sxy) between the face and the
/// surface's tangent at the middle of the edge.
class PlateMesh {
public:
    PlateMesh(const Topology& topology, const Cloth& cloth, const FabricTable& fabrics);

    int hinge_count() const { return int(faces_of_.size()); }
    int face_count() const { return int(faces_.size()); }
    int face(int hinge, int side) const { return faces_of_[hinge][side]; }
    int corner(int hinge, int side) const { return corners_of_[hinge][side]; }  ///< Edge of that face at the hinge.
    /// The hinge at an edge; -1 at a free edge and between held faces.
    int hinge(int face, int k) const { return faces_[face].hinge[k]; }
    /// 1 if both faces look the same way, -1 if one panel is sewn on turned over.
    double sign(int hinge) const { return signs_[hinge]; }
    bool rigid(int face) const { return faces_[face].rigid; }  ///< All corners are held.
    /// True if the hinge may be pooled with others: one fabric on both sides.
    bool mixes(int hinge) const { return faces_[face(hinge, 0)].fabric == faces_[face(hinge, 1)].fabric; }
    double area(int face) const { return faces_[face].area; }
    double rigidity(int face) const;  ///< Mean of weft and warp [N m].

    PlacedFace base(int hinge) const { return {face(hinge, 0), Mat2::Identity(), 1}; }
    /// The face beyond edge k of a placed one, unfolded about that edge.
    PlacedFace across(const PlacedFace& from, int k) const;
    Vec3 side_row(const PlacedFace& at, int k) const;  ///< Of one side of an edge [m].
    Vec3 turn_row(const PlacedFace& at, int k) const;  ///< Of the whole hinge, in the hinge's own sign [m].
    /// Curvature tensor (xx, yy, xy) of a face, in its own panel's coordinates, per turn on its side of edge k [1/m].
    Vec3 curvature_of_turn(int face, int k) const;
    /// Rigidities (xx, yy, xy) of a face with no moment across its free edges [N m].
    Mat3 free_stiffness(int face) const;

private:
    struct Edge {
        Vec2 along, inward;       // unit; counter-clockwise, and towards the corner
        double length, altitude;  // [m]
        double foot;              // of the corner along the edge [m]
    };
    struct PlateFace {
        std::array<Edge, 3> edge;
        std::array<int, 3> hinge = {-1, -1, -1};
        double area;
        const Fabric* fabric;
        bool rigid;
    };

    int side(int hinge, int of_face) const { return face(hinge, 0) == of_face ? 0 : 1; }

    std::vector<PlateFace> faces_;
    std::vector<std::array<int, 2>> faces_of_, corners_of_;
    std::vector<double> signs_;
};

}  // namespace selvage
