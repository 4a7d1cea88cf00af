#pragma once
#include <vector>

#include "host/model/cloth.hpp"
#include "host/solver/state/state.hpp"
#include "host/solver/state/topology.hpp"

namespace selvage {

/// Moves the held particles of a cloth along their prescribed paths.
class PinPaths {
public:
    PinPaths(const Cloth& cloth, const Topology& topology);

    double end() const { return end_; }  ///< Time after which all of them stand still [s]; 0 if none moves.
    /// The longest time within `room`, halved as often as needed, in which none moves further than `distance` [m].
    double longest_step(double time, double room, double distance) const;
    /// Puts them where they are at a time. Their velocities in the state stay zero, so that what integrators predict
    /// from velocities leaves them there.
    void move_to(State& state, double time) const;
    /// Where they are at a time: particle and position [m].
    std::vector<std::pair<int, Vec3>> places(double time) const;

private:
    struct Pin {
        int particle;
        Vec3 start;                ///< [m]
        std::vector<int> motions;  ///< Into motions_, in the order in which they act.
    };

    Vec3 position(const Pin& pin, double time) const;

    std::vector<PinMotion> motions_;
    std::vector<Pin> pins_;
    double end_ = 0;
};

}  // namespace selvage
