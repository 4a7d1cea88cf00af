#pragma once
#include <string>

#include "host/run/run.hpp"

namespace selvage {

/// Whether there is something to go on from in a folder, sound or not.
bool has_checkpoint(const std::string& folder);

/// Whether a folder holds the results of a run that came to its end.
bool has_ended(const std::string& folder);

/// Whether a folder without a checkpoint holds the results of a run of this scene that came to its end.
/// @throws InputError if they are those of another scene, or of a run to another end (solver.until), which cannot go on
bool is_done(const Scene& scene, const std::string& folder);

/// What is said where a run that came to its end is to be resumed.
RunOutcome nothing_left(const std::string& folder);

}  // namespace selvage
