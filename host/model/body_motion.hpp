#pragma once
#include <vector>

#include <Eigen/Geometry>

#include "io/geometry.hpp"

namespace selvage {

using Box = Eigen::AlignedBox3d;      ///< [m]
using Placement = Eigen::Isometry3d;  ///< From a body as it starts to where it is.

/// Where the rigid part of a motion is at a time.
struct MotionKey {
    double time = 0;                  ///< [s]
    Vec3 translation = Vec3::Zero();  ///< [m]
    Vec3 angles = Vec3::Zero();       ///< About x, then y, then z [rad].
};

/// The vertices of a deforming body at a time, before its rigid motion.
struct MeshPose {
    double time = 0;             ///< [s]
    std::vector<Vec3> vertices;  ///< [m]
    bool smooth = false;         ///< Reached from the pose before from rest to rest, else at a steady speed.
    double way = 0;              ///< Of the vertex that moves furthest from the pose before [m].
};

/// How a body moves: rigidly from key to key, and from pose to pose of its mesh. Keys and poses begin at time 0 with
/// the body as it starts; before the first and after the last it stands still.
class BodyMotion {
public:
    /// @param keys    times increase from 0; empty: no rigid motion
    /// @param smooth  between two keys by 3 s^2 - 2 s^3 instead of s
    /// @param pivot   the point that rotations turn about [m]
    BodyMotion(std::vector<MotionKey> keys, bool smooth, const Vec3& pivot);

    /// Adds a pose, later than the ones before; the first at time 0. All have the same number of vertices.
    void add_pose(double time, std::vector<Vec3> vertices, bool smooth);

    bool deforms() const { return poses_.size() > 1; }
    double end() const;                      ///< Time after which the body stands still [s].
    Placement placement(double time) const;  ///< Of the rigid part.
    /// The vertices at a time, before the rigid part.
    void vertices_at(double time, std::vector<Vec3>& vertices) const;
    /// Bounds the distance of any surface point between its places at two times [m].
    /// @param box  holds the body as it starts; poses are added to it
    double distance(double from, double to, const Box& box) const;
    /// About the highest speed of any surface point [m/s]. @param box  as for distance
    double highest_speed(const Box& box) const;
    std::size_t bytes() const;  ///< Of the poses.

private:
    std::vector<MotionKey> keys_;
    std::vector<MeshPose> poses_;
    Box reach_;  ///< Of all poses.
    bool smooth_;
    Vec3 pivot_;
};

}  // namespace selvage
