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
    std::uint32_t call = 0;  ///< Number of the scope's call; a task has that of its launch's scope.
    bool task = false;       ///< True: one task of a launch; false: a scope.
};

/// A node of the tree of scopes, with its cost over all calls.
struct TraceNode {
    std::string name;
    int parent = -1, depth = 0;
    std::int64_t calls = 0, nanoseconds = 0, inner_nanoseconds = 0;  ///< Inner: within child scopes.
    std::int64_t bytes = 0, flops = 0;                               ///< Over all calls; 0: not known.
    std::int64_t launches = 0;                                       ///< Made directly in this scope.
    std::vector<float> durations = {};                               ///< Duration of every call [s].
};

/// The events of one thread. A thread writes to its own track only.
struct TraceTrack {
    std::vector<TraceEvent> events;
    std::vector<std::int64_t> busy;  ///< Per scope: time in tasks [ns].
    std::int64_t shortest = 0;       ///< Shorter events were dropped [ns].
    std::int64_t left_out = 0;       ///< Number of dropped events.

    void add(const TraceEvent& event);

private:
    void thin();
};

/// Records a tree of scopes, entered by one thread, and the tasks that all threads run for them. Scopes and launches
/// find the trace through a thread-local pointer, which a TraceUse sets for its lifetime, so that no function has to
/// pass the trace on. Without a TraceUse they cost one test of that pointer. There are no locks, since every thread
/// writes to its own track.
class Trace {
public:
    /// The scope and call that the tasks of a launch belong to.
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
    static Mark mark() { return used_ ? used_->next_mark() : Mark{}; }  ///< For a launch that begins now.

    void open(std::string_view name);
    void close(std::int64_t bytes, std::int64_t flops);  ///< Closes the scope opened last.
    void add_task(const Mark& mark, std::int64_t begin);
    std::int64_t now() const
    {
        return std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::steady_clock::now() - start_).count();
    }

    /// All scopes, each after its parent; [0] is the whole run. Call this and tracks() only while no launch is running.
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
    TraceTrack* own_;  ///< Track of the thread that opens scopes.
};

/// Makes the calling thread record into a trace for the lifetime of this object, and into the previous one afterwards.
class TraceUse {
public:
    explicit TraceUse(Trace* trace) : before_(Trace::used_) { Trace::used_ = trace; }
    TraceUse(const TraceUse&) = delete;
    TraceUse& operator=(const TraceUse&) = delete;
    ~TraceUse() { Trace::used_ = before_; }

private:
    Trace* before_;
};

/// Records its own lifetime as a scope of the calling thread's trace, if it has one.
class TraceScope {
public:
    /// @param bytes, flops  memory traffic and floating-point operations of the scope; 0: not known
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

/// Records its own lifetime as a task of a launch.
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
