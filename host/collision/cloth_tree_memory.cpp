#include <algorithm>
#include <stdexcept>

#include "host/collision/cloth_tree.hpp"

namespace selvage {

TreeMemory ClothTree::memory(const TreeBodies& bodies) const
{
    TreeMemory memory;
    memory.asleep = asleep_;
    memory.valid = valid_ && body_version_ == bodies.version;
    if (!memory.valid) return memory;
    memory.start.assign(searched_start_.begin(), searched_start_.begin() + particles_);
    memory.end.assign(searched_end_.begin(), searched_end_.begin() + particles_);
    memory.slack.assign(slack_of_.begin(), slack_of_.begin() + particles_);
    memory.skipped = skipped_;
    memory.candidates = candidates_;
    memory.partial = partial_since_;
    return memory;
}

void ClothTree::set_memory(TreeMemory memory)
{
    const int fixed = int(start_.size()) - particles_;  // corners of bodies, counted from -1 downwards
    const auto is_corner = [&](int c) { return c < particles_ && c >= -fixed; };
    const auto fits = [&](const std::vector<PairCandidate>& candidates) {
        return std::all_of(candidates.begin(), candidates.end(), [&](const PairCandidate& candidate) {
            return std::all_of(candidate.corner.begin(), candidate.corner.end(), is_corner);
        });
    };
    const std::size_t particles = memory.valid ? std::size_t(particles_) : 0;
    const bool sizes =
        memory.start.size() == particles && memory.end.size() == particles && memory.slack.size() == particles;
    const bool nodes = std::all_of(memory.skipped.begin(), memory.skipped.end(),
                                   [this](int node) { return node >= 0 && node < int(nodes_.size()); });
    if (!sizes || !nodes || !fits(memory.candidates) || !fits(memory.asleep))
        throw std::invalid_argument("the memory of a tree over another surface");
    asleep_ = std::move(memory.asleep);
    valid_ = memory.valid;
    partial_since_ = memory.partial;
    if (!valid_) return;
    std::copy(memory.start.begin(), memory.start.end(), searched_start_.begin());
    std::copy(memory.end.begin(), memory.end.end(), searched_end_.begin());
    std::copy(memory.slack.begin(), memory.slack.end(), slack_of_.begin());
    skipped_ = std::move(memory.skipped);
    candidates_ = std::move(memory.candidates);
    note_skipped();
}

}  // namespace selvage
