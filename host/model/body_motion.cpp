#include "host/model/body_motion.hpp"

#include <algorithm>
#include <cmath>

namespace selvage {
namespace {

double eased(double s, bool smooth) { return smooth ? s * s * (3 - 2 * s) : s; }

// The two entries around a time, given by the later one, and the weight of the later one in between.
struct Between {
    std::size_t later = 0;
    double part = 0;  // 0 at the earlier, 1 at the later entry
};

template <class Entry>
Between between(const std::vector<Entry>& entries, double time)
{
    if (time <= entries.front().time) return {0, 1};
    const auto later = std::find_if(entries.begin(), entries.end(), [&](const Entry& e) { return e.time >= time; });
    if (later == entries.end()) return {entries.size() - 1, 1};
    const double start = (later - 1)->time;
    return {std::size_t(later - entries.begin()), (time - start) / (later->time - start)};
}

}  // namespace

Box box_of(const std::vector<Vec3>& points)
{
    Box box;
    for (const Vec3& x : points) box.extend(x);
    return box;
}

BodyMotion::BodyMotion(std::vector<MotionKey> keys, bool smooth, const Vec3& pivot)
    : keys_(std::move(keys)), smooth_(smooth), pivot_(pivot)
{
}

void BodyMotion::add_pose(double time, std::vector<Vec3> vertices, bool smooth)
{
    MeshPose pose{time, std::move(vertices), smooth, 0};
    reach_.extend(box_of(pose.vertices));
    if (!poses_.empty())
        for (std::size_t v = 0; v < pose.vertices.size(); ++v)
            pose.max_displacement =
                std::max(pose.max_displacement, (pose.vertices[v] - poses_.back().vertices[v]).norm());
    poses_.push_back(std::move(pose));
}

double BodyMotion::end() const
{
    return std::max(keys_.empty() ? 0 : keys_.back().time, poses_.empty() ? 0 : poses_.back().time);
}

Placement BodyMotion::placement(double time) const
{
    Placement place = Placement::Identity();
    if (keys_.empty()) return place;
    const Between at = between(keys_, time);
    Vec3 translation = keys_[at.later].translation, angles = keys_[at.later].angles;
    if (at.part < 1) {
        const double part = eased(at.part, smooth_);
        const MotionKey& before = keys_[at.later - 1];
        translation = before.translation + part * (translation - before.translation);
        angles = before.angles + part * (angles - before.angles);
    }
    place.translate(translation + pivot_);
    place.rotate(Eigen::AngleAxisd(angles.z(), Vec3::UnitZ()) * Eigen::AngleAxisd(angles.y(), Vec3::UnitY()) *
                 Eigen::AngleAxisd(angles.x(), Vec3::UnitX()));
    place.translate(-pivot_);
    return place;
}

void BodyMotion::vertices_at(double time, std::vector<Vec3>& vertices) const
{
    const Between at = between(poses_, time);
    vertices = poses_[at.later].vertices;
    if (at.part >= 1) return;
    const double part = eased(at.part, poses_[at.later].smooth);
    const std::vector<Vec3>& before = poses_[at.later - 1].vertices;
    for (std::size_t v = 0; v < vertices.size(); ++v) vertices[v] = before[v] + part * (vertices[v] - before[v]);
}

double BodyMotion::distance(double from, double to, const Box& box) const
{
    double deformation = 0;
    for (std::size_t k = 1; k < poses_.size(); ++k) {
        const double start = poses_[k - 1].time, length = poses_[k].time - start;
        const auto part = [&](double time) {
            return eased(std::clamp((time - start) / length, 0.0, 1.0), poses_[k].smooth);
        };
        deformation += poses_[k].max_displacement * std::abs(part(to) - part(from));
    }
    if (keys_.empty()) return deformation;
    // The length of a rigid displacement is a convex function of the point, so over a box it is largest at a corner.
    const Placement before = placement(from), after = placement(to);
    const Box around = box.merged(reach_);
    double rigid = 0;
    for (int corner = 0; corner < 8; ++corner) {
        const Vec3 x = around.corner(Box::CornerType(corner));
        rigid = std::max(rigid, (after * x - before * x).norm());
    }
    return deformation + rigid;
}

Box BodyMotion::box_at(double time, const Box& box) const
{
    const Placement place = placement(time);
    const Box around = box.merged(reach_);
    Box result;
    for (int corner = 0; corner < 8; ++corner) result.extend(place * around.corner(Box::CornerType(corner)));
    return result;
}

double BodyMotion::highest_speed(const Box& box) const
{
    constexpr int samples = 200;  // over the whole motion; chosen by hand, not measured
    const double dt = end() / samples;
    double highest = 0;
    for (int k = 0; k < samples && dt > 0; ++k) highest = std::max(highest, distance(k * dt, (k + 1) * dt, box) / dt);
    return highest;
}

std::size_t BodyMotion::bytes() const
{
    return poses_.empty() ? 0 : poses_.size() * poses_.front().vertices.size() * sizeof(Vec3);
}

}  // namespace selvage
