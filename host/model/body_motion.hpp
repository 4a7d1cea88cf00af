#pragma once
#include <vector>

#include <Eigen/Geometry>

#include "io/geometry.hpp"

namespace selvage {

using Box = Eigen::AlignedBox3d;      ///< [m]
using Placement = Eigen::Isometry3d;  ///< Maps a body from its place at time 0 to where it is.

/// Returns the box around some points; empty without any.
Box box_of(const std::vector<Vec3>& points);

/// The rigid displacement of a body at one time.
struct MotionKey {
    double time = 0;                  ///< [s]
    Vec3 translation = Vec3::Zero();  ///< [m]
    Vec3 angles = Vec3::Zero();       ///< About x, then y, then z [rad].
};

/// The vertices of a deforming body at a time, before its rigid motion.
struct MeshPose {
    double time = 0;              ///< [s]
    std::vector<Vec3> vertices;   ///< [m]
    bool smooth = false;          ///< Reached by 3 s^2 - 2 s^3 from the previous pose, else linearly.
    double max_displacement = 0;  ///< Largest distance of a vertex from the previous pose [m].
};

/// The prescribed motion of a body: interpolation of its mesh between poses, followed by a rigid displacement
/// interpolated between keys. Keys and poses begin at time 0 with the body as the scene places it. The body stands
/// still before the first and after the last.
class BodyMotion {
public:
    /// @param keys    times increase from 0; empty: no rigid motion
    /// @param smooth  interpolates between two keys by 3 s^2 - 2 s^3 instead of s
    /// @param pivot   the point that rotations turn about [m]
    BodyMotion(std::vector<MotionKey> keys, bool smooth, const Vec3& pivot);

    /// Adds a pose, later than the ones before; the first at time 0. All have the same number of vertices.
    void add_pose(double time, std::vector<Vec3> vertices, bool smooth);

    bool deforms() const { return poses_.size() > 1; }
    double end() const;                      ///< Time after which the body stands still [s].
    Placement placement(double time) const;  ///< Rigid part at a time [s].
    /// Writes the vertices [m] at a time [s], without the rigid part.
    void vertices_at(double time, std::vector<Vec3>& vertices) const;
    /// Returns an upper bound of the distance between the positions of any surface point at two times [m].
    /// @param box  a box around the body at time 0; the poses are added to it
    double distance(double from, double to, const Box& box) const;
    /// Returns a box around the body at a time [m]. @param box  as for distance
    Box box_at(double time, const Box& box) const;
    /// Estimates the highest speed of any surface point from samples of the motion [m/s]. @param box  as for distance
    double highest_speed(const Box& box) const;
    std::size_t bytes() const;  ///< Memory of the poses.

private:
    std::vector<MotionKey> keys_;
    std::vector<MeshPose> poses_;
    Box reach_;  ///< Box around all poses.
    bool smooth_;
    Vec3 pivot_;
};

}  // namespace selvage
