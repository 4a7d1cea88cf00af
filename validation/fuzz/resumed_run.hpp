#pragma once
#include <string>
#include <vector>

namespace selvage {

/// Returns checkpoints of small runs as they are written: of steps in contact and of explicit ones, which keep what
/// their searches found.
/// @param folder  in which their scene is left
std::vector<std::string> resumed_corpus(const std::string& folder);

/// Goes on from a checkpoint of any of these runs in that folder, by one step.
void go_on_from(const std::string& path);

}  // namespace selvage
