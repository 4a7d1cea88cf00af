#include "host/parallel/trace.hpp"

#include <algorithm>

#include <tbb/enumerable_thread_specific.h>

namespace selvage {
namespace {

// Limits of a trace's size. Chosen by hand; not measured.
struct TraceTuning {
    static constexpr std::size_t max_events = 200000;     // per track, so that a browser can still open the trace
    static constexpr std::int64_t merge_gap = 20000;      // shorter gaps between tasks of one call are closed [ns]
    static constexpr std::int64_t first_shortest = 1000;  // first threshold below which events are dropped [ns]
};

}  // namespace

// Drops the shortest events until at most half of the limit is left. The other events stay properly nested, since any
// subset of nested spans is nested.
void TraceTrack::thin()
{
    const std::size_t before = events.size();
    while (events.size() > TraceTuning::max_events / 2) {
        shortest = std::max(TraceTuning::first_shortest, 2 * shortest);
        std::erase_if(events, [this](const TraceEvent& event) { return event.end - event.begin < shortest; });
    }
    left_out += std::int64_t(before - events.size());
}

void TraceTrack::add(const TraceEvent& event)
{
    if (event.task) {
        if (busy.size() <= std::size_t(event.scope)) busy.resize(std::size_t(event.scope) + 1);
        busy[std::size_t(event.scope)] += event.end - event.begin;
        if (!events.empty()) {
            TraceEvent& last = events.back();
            if (last.task && last.call == event.call && last.scope == event.scope &&
                event.begin - last.end < TraceTuning::merge_gap) {
                // A task that waits may run other tasks meanwhile. They were recorded first and lie within its span, so
                // their time must not count twice.
                if (event.begin < last.begin) busy[std::size_t(event.scope)] -= last.end - last.begin;
                last.begin = std::min(last.begin, event.begin);
                last.end = event.end;
                return;
            }
        }
    }
    if (event.end - event.begin < shortest) {
        ++left_out;
        return;
    }
    events.push_back(event);
    if (events.size() >= TraceTuning::max_events) thin();
}

struct Trace::ThreadTracks {
    tbb::enumerable_thread_specific<TraceTrack> of_thread;
};

Trace::Trace()
    : nodes_{{.name = "run"}}, children_(1), tracks_(std::make_unique<ThreadTracks>()),
      own_(&tracks_->of_thread.local())
{
}

Trace::~Trace() = default;

void Trace::open(std::string_view name)
{
    const auto& siblings = children_[std::size_t(current_)];
    const auto known = std::find_if(siblings.begin(), siblings.end(),
                                    [&](int child) { return nodes_[std::size_t(child)].name == name; });
    int node = known == siblings.end() ? int(nodes_.size()) : *known;
    if (known == siblings.end()) {
        nodes_.push_back(
            {.name = std::string(name), .parent = current_, .depth = nodes_[std::size_t(current_)].depth + 1});
        children_[std::size_t(current_)].push_back(node);
        children_.emplace_back();
    }
    open_.push_back({now(), current_, call_});
    current_ = node;
    call_ = ++calls_;
}

void Trace::close(std::int64_t bytes, std::int64_t flops)
{
    const Open opened = open_.back();
    const std::int64_t end = now(), length = end - opened.begin;
    TraceNode& node = nodes_[std::size_t(current_)];
    ++node.calls;
    node.nanoseconds += length;
    node.bytes += bytes;
    node.flops += flops;
    node.durations.push_back(float(1e-9 * double(length)));
    nodes_[std::size_t(opened.parent)].inner_nanoseconds += length;
    own_->add({opened.begin, end, current_, call_, false});
    current_ = opened.parent;
    call_ = opened.parent_call;
    open_.pop_back();
}

void Trace::add_task(const Mark& mark, std::int64_t begin)
{
    tracks_->of_thread.local().add({begin, now(), mark.scope, mark.call, true});
}

std::vector<TraceTrack> Trace::tracks() const
{
    std::vector<TraceTrack> result{*own_};
    for (const TraceTrack& track : tracks_->of_thread)
        if (&track != own_) result.push_back(track);
    const auto outer_first = [this](const TraceEvent& a, const TraceEvent& b) {
        if (a.begin != b.begin) return a.begin < b.begin;
        if (a.end != b.end) return a.end > b.end;
        if (a.task != b.task) return b.task;
        return nodes_[std::size_t(a.scope)].depth < nodes_[std::size_t(b.scope)].depth;
    };
    for (TraceTrack& track : result) std::sort(track.events.begin(), track.events.end(), outer_first);
    return result;
}

}  // namespace selvage
