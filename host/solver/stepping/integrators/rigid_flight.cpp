#include "host/solver/stepping/integrators/rigid_flight.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

#include <Eigen/Dense>

#include "host/parallel/launch.hpp"
#include "host/parallel/reduce.hpp"
#include "host/solver/state/planes.hpp"
#include "host/solver/state/vectors.hpp"
#include "io/geometry.hpp"

namespace selvage {
namespace {

// Weight of a free vertex where others of its piece are held, whose weight is 1: the piece turns about these, and how
// fast it turns about the axis on which they lie is told by the free ones.
constexpr double free_weight = 1e-6;

// Added to the moments of inertia, as part of their trace: a piece that is a straight thread, or a point, has none
// about its own axis.
constexpr double least_inertia = 1e-12;

class Connections {
public:
    explicit Connections(int count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0); }

    int root(int v)
    {
        while (parent_[v] != v) v = parent_[v] = parent_[parent_[v]];
        return v;
    }

    // Joins the corners of all elements of a kind. @param corner  planes of `stride` indices
    void join(const std::vector<int>& corner, int corners, int count, int stride)
    {
        if (corner.empty()) return;
        for (int element = 0; element < count; ++element)
            for (int c = 1; c < corners; ++c) {
                // The smaller index becomes the root, so that pieces are numbered by their first vertices.
                const int a = root(corner[element]), b = root(corner[c * stride + element]);
                parent_[std::max(a, b)] = std::min(a, b);
            }
    }

private:
    std::vector<int> parent_;
};

// Sums over the vertices of a piece, weighted.
struct Linear {
    double mass = 0;
    Vec3 place = Vec3::Zero(), velocity = Vec3::Zero(), acceleration = Vec3::Zero();

    Linear operator+(const Linear& o) const
    {
        return {mass + o.mass, place + o.place, velocity + o.velocity, acceleration + o.acceleration};
    }
};

struct Angular {
    Mat3 inertia = Mat3::Zero();
    Vec3 momentum = Vec3::Zero(), torque = Vec3::Zero();

    Angular operator+(const Angular& o) const
    {
        return {inertia + o.inertia, momentum + o.momentum, torque + o.torque};
    }
};

// @param angle  axis times angle [rad]
Mat3 rotation_by(const Vec3& angle)
{
    if (!(angle.norm() > 0)) return Mat3::Identity();
    return Eigen::AngleAxisd(angle.norm(), angle.normalized()).toRotationMatrix();
}

}  // namespace

struct RigidFlight::Motion {
    Vec3 center, velocity, acceleration;  ///< Of the center.
    Vec3 spin, turning;                   ///< Angular velocity [1/s] and acceleration [1/s^2].
};

RigidFlight::RigidFlight(const State& state)
{
    const mesh_sizes& size = state.size;
    Connections connections(size.vertex_count);
    connections.join(state.face_vertex, 3, size.face_count, size.face_stride);
    connections.join(state.spring_vertex, 2, size.spring_count, size.spring_stride);
    std::vector<int> piece(size.vertex_count, -1), count;
    for (int v = 0; v < size.vertex_count; ++v) {
        const int root = connections.root(v);
        if (root == v) {
            piece[v] = int(count.size());
            count.push_back(0);
        }
        piece[v] = piece[root];
        ++count[piece[v]];
    }
    first_.assign(count.size() + 1, 0);
    std::partial_sum(count.begin(), count.end(), first_.begin() + 1);
    vertices_.resize(size.vertex_count);
    std::vector<int> next(first_.begin(), first_.end() - 1);
    for (int v = 0; v < size.vertex_count; ++v) vertices_[next[piece[v]]++] = v;
}

RigidFlight::Motion RigidFlight::motion_of(const State& state, int piece, const std::vector<real>& acceleration) const
{
    const ConstPlanes x = vertex_planes(state.size, state.pos), u = vertex_planes(state.size, state.vel),
                      a = vertex_planes(state.size, acceleration);
    const int* vertex = vertices_.data() + first_[piece];
    const int count = first_[piece + 1] - first_[piece];
    const bool held =
        sum_items(count, [&state, vertex](int i) { return state.inv_mass[vertex[i]] == 0 ? 1.0 : 0.0; }) > 0;
    const auto weight = [&state, held](int v) {
        if (!held) return double(state.mass[v]);
        return state.inv_mass[v] == 0 ? 1.0 : free_weight;
    };
    Linear linear = reduce_items(count, Linear{}, [&](int i, Linear& sum) {
        const int v = vertex[i];
        const double m = weight(v);
        sum.mass += m;
        sum.place += m * x(v);
        sum.velocity += m * u(v);
        sum.acceleration += m * a(v);
    });
    Motion motion{linear.place / linear.mass, linear.velocity / linear.mass, linear.acceleration / linear.mass, {}, {}};
    Angular angular = reduce_items(count, Angular{}, [&](int i, Angular& sum) {
        const int v = vertex[i];
        const double m = weight(v);
        const Vec3 y = x(v) - motion.center;
        sum.inertia += m * (y.squaredNorm() * Mat3::Identity() - y * y.transpose());
        sum.momentum += m * y.cross(u(v) - motion.velocity);
        sum.torque += m * y.cross(a(v) - motion.acceleration);
    });
    angular.inertia += (least_inertia * angular.inertia.trace() + 1e-300) * Mat3::Identity();
    const auto solver = angular.inertia.ldlt();
    motion.spin = solver.solve(angular.momentum);
    motion.turning = solver.solve(angular.torque);
    return motion;
}

void RigidFlight::predict(const State& state, double ahead, double half, const std::vector<real>& acceleration,
                          std::vector<real>& place) const
{
    const ConstPlanes x = vertex_planes(state.size, state.pos), u = vertex_planes(state.size, state.vel);
    place.resize(state.pos.size());
    const Planes to = vertex_planes(state.size, place);
    for (int piece = 0; piece + 1 < int(first_.size()); ++piece) {
        const Motion m = motion_of(state, piece, acceleration);
        const Vec3 angle = ahead * m.spin + half * m.turning,
                   center = m.center + ahead * m.velocity + half * m.acceleration;
        const Mat3 turn = rotation_by(angle);
        const int* vertex = vertices_.data() + first_[piece];
        for_each_item(first_[piece + 1] - first_[piece], [&](int i) {
            const int v = vertex[i];
            const Vec3 y = x(v) - m.center, within = u(v) - m.velocity - m.spin.cross(y);
            to.set(v, state.inv_mass[v] == 0 ? x(v) : Vec3(center + turn * (y + ahead * within)));
        });
    }
}

void RigidFlight::fly(const State& state, double ahead, const std::vector<real>& acceleration, std::vector<real>& place,
                      std::vector<real>& velocity) const
{
    predict(state, ahead, 0.5 * ahead * ahead, acceleration, place);
    const ConstPlanes x = vertex_planes(state.size, state.pos), u = vertex_planes(state.size, state.vel),
                      then = vertex_planes(state.size, std::as_const(place));
    velocity.resize(state.pos.size());
    const Planes to = vertex_planes(state.size, velocity);
    for (int piece = 0; piece + 1 < int(first_.size()); ++piece) {
        const Motion m = motion_of(state, piece, acceleration);
        const Vec3 center = m.center + ahead * m.velocity + 0.5 * ahead * ahead * m.acceleration,
                   speed = m.velocity + ahead * m.acceleration, spin = m.spin + ahead * m.turning;
        const Mat3 turn = rotation_by(ahead * m.spin + 0.5 * ahead * ahead * m.turning);
        const int* vertex = vertices_.data() + first_[piece];
        for_each_item(first_[piece + 1] - first_[piece], [&](int i) {
            const int v = vertex[i];
            const Vec3 within = u(v) - m.velocity - m.spin.cross(x(v) - m.center);
            to.set(v,
                   state.inv_mass[v] == 0 ? Vec3::Zero() : Vec3(speed + spin.cross(then(v) - center) + turn * within));
        });
    }
}

void fill_gravity(const State& state, const Params& params, std::vector<real>& acceleration)
{
    const auto& g = params.gravity;
    const Vec3 gravity(g.acceleration_x, g.acceleration_y, g.acceleration_z);
    acceleration.assign(state.pos.size(), 0);
    const Planes to = vertex_planes(state.size, acceleration);
    for_each_item(state.size.vertex_count, [&](int v) {
        if (state.inv_mass[v] != 0) to.set(v, gravity);
    });
}

void fill_acceleration(const State& state, const Params& params, const std::vector<real>& gain, double dt,
                       std::vector<real>& acceleration)
{
    if (!(dt > 0)) return fill_gravity(state, params, acceleration);
    acceleration = gain;
    divide(acceleration, dt);
}

}  // namespace selvage
