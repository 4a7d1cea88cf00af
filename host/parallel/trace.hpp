#pragma once
#include <chrono>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace selvage {

/// A span on the track of one thread, [ns] since the trace began.
struct TraceEvent {
    std::int64_t begin = 0, end = 0;
    int scope = 0;           ///< Index into Trace::scopes().
    std::uint32_t call = 0;  ///< Tells the calls of scopes apart.
    bool task = false;       ///< Work on items of a launch; false: the scope itself.
};

/// A named place in the tree of calls, and what was spent there.
struct TraceNode {
    std::string name;
    int parent = -1, depth = 0;
    std::int64_t calls = 0, nanoseconds = 0, inner_nanoseconds = 0;  ///< Inner: in the scopes below.
    std::int64_t bytes = 0, flops = 0;                               ///< Over all calls; 0: not known.
    std::int64_t launches = 0;                                       ///< By itself, over all calls.
    std::vector<float> durations = {};                               ///< Of every call [s].
};

/// What one thread did. A thread writes to its own track only.
struct TraceTrack {
    std::vector<TraceEvent> events;
    std::vector<std::int64_t> busy;  ///< Per scope: time in tasks [ns].
    std::int64_t shortest = 0;       ///< Events below it were left out [ns].
    std::int64_t left_out = 0;

    void add(const TraceEvent& event);

private:
    void thin();
};

/// Records a tree of scopes, entered by one thread, and the tasks that all threads run for them.
/// Nobody has to pass it on: while a TraceUse lives, scopes and launches of its thread find it there. Without one
/// they test one pointer and go on. There are no locks: every thread has a track of its own.
class Trace {
public:
    /// How a launch tells its tasks where they belong.
    struct Mark {
        Trace* trace = nullptr;
        int scope = 0;
        std::uint32_t call = 0;
    };

    Trace();
    ~Trace();
    Trace(const Trace&) = delete;
    Trace& operator=(const Trace&) = delete;

    static Trace* here() { return used_; }  ///< The trace in use by the calling thread, or null.
    static Mark mark() { return used_ ? used_->next_mark() : Mark{}; }  ///< Of a launch that begins now.

    void open(std::string_view name);
    void close(std::int64_t bytes, std::int64_t flops);  ///< The scope opened last.
    void add_task(const Mark& mark, std::int64_t begin);
    std::int64_t now() const
    {
        return std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::steady_clock::now() - start_).count();
    }

    /// All scopes, each after its parent; [0] is the whole. Call it and the next when no launch is running.
    const std::vector<TraceNode>& scopes() const { return nodes_; }
    /// The tracks, the one of the thread that made the trace first; each sorted so that outer spans precede inner ones.
    std::vector<TraceTrack> tracks() const;

private:
    friend class TraceUse;
    struct Open {
        std::int64_t begin;
        int parent;
        std::uint32_t parent_call;
    };

    Mark next_mark()
    {
        ++nodes_[std::size_t(current_)].launches;
        return {this, current_, call_};
    }

    static thread_local constinit inline Trace* used_ = nullptr;

    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
    std::vector<TraceNode> nodes_;
    std::vector<std::vector<int>> children_;
    std::vector<Open> open_;
    int current_ = 0;
    std::uint32_t call_ = 0, calls_ = 0;
    struct ThreadTracks;
    std::unique_ptr<ThreadTracks> tracks_;
    TraceTrack* own_;  ///< Of the thread that opens scopes.
};

/// Lets the calling thread record into a trace for as long as this lives.
class TraceUse {
public:
    explicit TraceUse(Trace* trace) : before_(Trace::used_) { Trace::used_ = trace; }
    TraceUse(const TraceUse&) = delete;
    TraceUse& operator=(const TraceUse&) = delete;
    ~TraceUse() { Trace::used_ = before_; }

private:
    Trace* before_;
};

/// Records its own life as a scope of the trace in use, if any.
class TraceScope {
public:
    /// @param bytes, flops  that the scope moves and computes; 0: not known
    explicit TraceScope(std::string_view name, std::int64_t bytes = 0, std::int64_t flops = 0)
        : trace_(Trace::here()), bytes_(bytes), flops_(flops)
    {
        if (trace_) trace_->open(name);
    }
    TraceScope(const TraceScope&) = delete;
    TraceScope& operator=(const TraceScope&) = delete;
    ~TraceScope()
    {
        if (trace_) trace_->close(bytes_, flops_);
    }

private:
    Trace* trace_;
    std::int64_t bytes_, flops_;
};

/// Records its own life as a task of a launch.
class TaskSpan {
public:
    explicit TaskSpan(const Trace::Mark& mark) : mark_(mark), begin_(mark.trace ? mark.trace->now() : 0) {}
    TaskSpan(const TaskSpan&) = delete;
    TaskSpan& operator=(const TaskSpan&) = delete;
    ~TaskSpan()
    {
        if (mark_.trace) mark_.trace->add_task(mark_, begin_);
    }

private:
    const Trace::Mark& mark_;
    std::int64_t begin_;
};

}  // namespace selvage
