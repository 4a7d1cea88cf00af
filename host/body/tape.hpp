#pragma once
#include <vector>

#include "host/body/skin.hpp"

namespace selvage {

/// Which faces of a skin count.
using FaceMask = std::vector<char>;

/// Returns the points in which a plane crosses the edges of faces, two for each face.
std::vector<Vec3> section(const Skin& skin, const FaceMask& mask, const Vec3& point, const Vec3& normal);

/// A tape laid around the body in a plane: it bridges hollows, so it is the convex hull of the section.
struct Tape {
    std::vector<Vec3> points;  ///< A closed polygon [m]; empty where the plane meets nothing.
    double length = 0;         ///< [m]
    bool over_hole = false;    ///< The section runs through a hole of the skin: the tape bridges it.

    Vec3 middle() const;              ///< Of the enclosed area.
    std::vector<Vec3> sides() const;  ///< Both ends of each side, as crossings() takes them.
};

/// Lays a tape around points of a plane.
Tape tape_over(const std::vector<Vec3>& points, const Vec3& point, const Vec3& normal);

/// Returns the points in which lines meet a plane.
/// @param points  both ends of each line, as of section()
std::vector<Vec3> crossings(const std::vector<Vec3>& points, const Vec3& point, const Vec3& normal);

Tape tape_around(const Skin& skin, const FaceMask& mask, const Vec3& point, const Vec3& normal);

}  // namespace selvage
