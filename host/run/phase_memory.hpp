#pragma once
#include <string>

#include "host/solver/stepping/integrator.hpp"
#include "host/solver/stepping/phase.hpp"
#include "io/run/checkpoint.hpp"

namespace selvage {

/// Puts into a checkpoint all of a phase that its next step depends on: the fields that carry the past, what the last
/// look at contacts found, what friction and the integrator remember, what crosses and what sleeps. docs/resume.md
/// lists it.
void save_phase(Checkpoint& checkpoint, const Phase& phase, Integrator& integrator);

/// Puts it into a phase of the same cloth, which then goes on as the saved one did, bit for bit.
/// @param path  of the checkpoint, for messages
/// @throws InputError if an array is missing, has another size, or holds what cannot be
void load_phase(const Checkpoint& checkpoint, const std::string& path, Phase& phase, Integrator& integrator);

}  // namespace selvage
