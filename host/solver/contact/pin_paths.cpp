#include "host/solver/contact/pin_paths.hpp"

#include <algorithm>
#include <map>
#include <numbers>

#include <Eigen/Geometry>

namespace selvage {
namespace {

// Parts of a step whose displacements are added up, so that a pin that turns and comes back is not taken for one at
// rest. By hand.
constexpr int motion_parts = 4;

Vec3 moved(const PinMotion& motion, const Vec3& x, double time)
{
    const double passed = std::clamp(time - motion.start, 0.0, motion.end - motion.start);
    const double angle = 2 * std::numbers::pi * motion.turns * passed / (motion.end - motion.start);
    return motion.point + Eigen::AngleAxisd(angle, motion.axis) * (x - motion.point) + passed * motion.velocity;
}

}  // namespace

PinPaths::PinPaths(const Cloth& cloth, const Topology& topology) : motions_(cloth.pin_motions)
{
    std::map<int, Pin> pin_of;  // by particle
    for (int m = 0; m < int(motions_.size()); ++m) {
        end_ = std::max(end_, motions_[m].end);
        for (const int v : motions_[m].vertices) {
            const int particle = topology.particle_of[v];
            Pin& pin = pin_of.try_emplace(particle, Pin{particle, cloth.positions[v], {}}).first->second;
            if (pin.motions.empty() || pin.motions.back() != m) pin.motions.push_back(m);  // of vertices at a seam
        }
    }
    for (auto& [particle, pin] : pin_of) pins_.push_back(std::move(pin));
}

Vec3 PinPaths::position(const Pin& pin, double time) const
{
    Vec3 x = pin.start;
    for (const int m : pin.motions) x = moved(motions_[m], x, time);
    return x;
}

double PinPaths::longest_step(double time, double room, double distance) const
{
    const auto too_far = [&](double dt) {
        return std::any_of(pins_.begin(), pins_.end(), [&](const Pin& pin) {
            double sum = 0;
            for (int k = 0; k < motion_parts; ++k)
                sum += (position(pin, time + (k + 1) * dt / motion_parts) - position(pin, time + k * dt / motion_parts))
                           .norm();
            return sum > distance;
        });
    };
    double dt = room;
    while (too_far(dt) && dt > 1e-6 * room) dt *= 0.5;
    return dt;
}

std::vector<std::pair<int, Vec3>> PinPaths::places(double time) const
{
    std::vector<std::pair<int, Vec3>> result;
    for (const Pin& pin : pins_) result.push_back({pin.particle, position(pin, time)});
    return result;
}

void PinPaths::move_to(State& state, double time) const
{
    const int vs = state.size.vertex_stride;
    for (const Pin& pin : pins_) {
        const Vec3 x = position(pin, time);
        for (int c = 0; c < 3; ++c) state.pos[c * vs + pin.particle] = x[c];
    }
}

}  // namespace selvage
