#pragma once
#include <chrono>
#include <cstdio>
#include <deque>
#include <limits>
#include <string>

namespace selvage {

/// The present state of a run.
struct ProgressState {
    std::string phase;  ///< Such as `sewing` or `draping`.
    double time = 0;    ///< Simulated [s].
    long step = 0;
    double residual = std::numeric_limits<double>::quiet_NaN();  ///< Relative force residual [1]; NaN: unknown.
    double left = std::numeric_limits<double>::quiet_NaN();      ///< What the step has not found [1]; NaN: not asked.
    double error = std::numeric_limits<double>::quiet_NaN();     ///< Estimated, of the step in time [m]; NaN: unknown.
    int frames = 0;                                              ///< Frames written so far.
};

struct ProgressOptions {
    std::string path;                                           ///< progress.jsonl; empty: no file.
    bool append = false;                                        ///< Append to the file instead of replacing it.
    bool quiet = false;                                         ///< Print nothing on stderr.
    double end_time = std::numeric_limits<double>::infinity();  ///< Simulated [s]; infinite: run to equilibrium.
    double tolerance = 0;                                       ///< Residual at which a run to equilibrium ends.
};

/// Estimates the wall time that is left.
class EtaEstimate {
public:
    /// @param end_time   simulated time at which the run ends, or infinity
    /// @param tolerance  residual at which it ends, if end_time is infinite
    EtaEstimate(double end_time, double tolerance) : end_time_(end_time), tolerance_(tolerance) {}

    /// @param wall  wall time since the start [s]
    void add(double wall, const ProgressState& state);
    void restart() { samples_.clear(); }  ///< Discards all samples; called when another phase begins.

    /// Returns the wall time left [s], or NaN while there is no trend. With an end time the estimate extrapolates the
    /// simulated time per wall time; otherwise it extrapolates a line fitted to the logarithm of the recent residuals.
    double seconds_left() const;

private:
    struct Sample {
        double wall, time, log_residual;
    };
    double end_time_, tolerance_;
    std::deque<Sample> samples_;
};

/// Reports the progress of a run to other programs (a file of JSON lines) and to the user (stderr).
class ProgressReport {
public:
    /// @throws WriteError if the file cannot be written.
    explicit ProgressReport(const ProgressOptions& options);
    ProgressReport(const ProgressReport&) = delete;
    ProgressReport& operator=(const ProgressReport&) = delete;
    ~ProgressReport();  ///< Ends the line that is updated in place on a terminal, if there is one.

    /// Adds a line to the file; shows the state on a terminal at most 5 times a second, otherwise every 2 s, and
    /// at once when a phase begins.
    /// @throws WriteError if the line cannot be written; the file then ends with the line before
    void update(const ProgressState& state);

    /// Writes a line of text to stderr without overwriting the line that is updated in place; nothing if quiet.
    void message(const std::string& text);
    /// The same for what must be known: `quiet` does not silence it.
    void warning(const std::string& text);

private:
    double elapsed() const;
    void write_line(const ProgressState& state, double wall, double seconds_left);
    void show(const ProgressState& state, double wall, double seconds_left);
    void clear_live_line();

    ProgressOptions options_;
    EtaEstimate estimate_;
    int file_ = -1;  ///< Descriptor of the file; -1: none.
    std::chrono::steady_clock::time_point start_;
    std::string phase_;
    double shown_at_;  ///< Wall time since the start [s].
    bool terminal_, live_line_ = false;
};

}  // namespace selvage
