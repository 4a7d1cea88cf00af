#include "host/model/motion_reach.hpp"

namespace selvage {
namespace {

// By hand.
struct ReachTuning {
    static constexpr int parts = 64;     // of a motion
    static constexpr double fall = 100;  // [m]
};

}  // namespace

Box swing_reach(const Box& start, const Vec3& down)
{
    const Vec3 size = Vec3::Constant(start.diagonal().norm());
    Box reach(start.min() - size, start.max() + size);
    const Vec3 fall = down.isZero() ? Vec3(Vec3::Zero()) : Vec3(ReachTuning::fall * down.normalized());
    reach.extend(Box(reach.min() + fall, reach.max() + fall));
    return reach;
}

bool moves_within(const Body& body, const Box& reach)
{
    if (!body.motion || body.motion->end() == 0) return false;
    if (body.kind == Body::Kind::plane) return true;
    const Box box = box_of(body.mesh.vertices);
    for (int k = 0; k < ReachTuning::parts; ++k) {
        const double from = body.motion->end() * k / ReachTuning::parts;
        const double to = body.motion->end() * (k + 1) / ReachTuning::parts;
        if (reach.exteriorDistance(body.motion->box_at(from, box)) <= body.motion->distance(from, to, box)) return true;
    }
    return false;
}

}  // namespace selvage
