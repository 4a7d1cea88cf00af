#pragma once
#include <vector>

#include "host/solver/state/state.hpp"

namespace selvage {

/// Keeps the contact fields of a state up to date: what the contact and friction terms read.
class ContactField {
public:
    virtual ~ContactField() = default;
    /// Finds the nearest body surface of every vertex that may touch one, and writes its tangent plane.
    virtual void update(State& state) = 0;
    /// Returns true if a vertex went deep into a body on its straight way from `from` (planes like pos) to state.pos.
    virtual bool crossed(const State& state, const std::vector<real>& from) = 0;
    /// Vertices further than this from any body may move freely in one iteration [m].
    virtual double search_radius() const = 0;
    virtual int contact_count() const = 0;  ///< Vertices within the contact gap after the last update.
};

}  // namespace selvage
