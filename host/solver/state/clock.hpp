#pragma once

namespace selvage {

/// The time of a system: the state, the bodies and the held vertices are where they are then.
struct Clock {
    double time = 0;  ///< Of the state; while a step is being taken, of its start [s].
    double dt = 0;    ///< Length of that step; 0 between steps [s].

    double end() const { return time + dt; }  ///< Of the step [s].
};

}  // namespace selvage
