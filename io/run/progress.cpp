#include "io/run/progress.hpp"

#include <algorithm>
#include <cerrno>
#include <cmath>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>
#include <nlohmann/json.hpp>

#include "io/atomic_file.hpp"

namespace selvage {
namespace {

// How progress is shown and extrapolated. All values were chosen by hand; none was measured.
struct ProgressTuning {
    static constexpr double live_interval = 0.2;      // wall time between updates of a terminal's line [s]
    static constexpr double plain_interval = 2;       // wall time between lines when stderr is not a terminal [s]
    static constexpr std::size_t most_samples = 200;  // recent steps to which the trend is fitted
    static constexpr std::size_t least_samples = 8;   // steps without which no trend of the residual is reported
};

nlohmann::ordered_json number(double value)
{
    return std::isfinite(value) ? nlohmann::ordered_json(value) : nlohmann::ordered_json(nullptr);
}

std::string duration(double seconds)
{
    const auto whole = (long long)(std::ceil(seconds));
    if (whole < 60) return fmt::format("{} s", whole);
    if (whole < 3600) return fmt::format("{} min {:02} s", whole / 60, whole % 60);
    return fmt::format("{} h {:02} min", whole / 3600, whole / 60 % 60);
}

// Opens a file for whole lines at its end. What is there already is only written to if it is a file of its own.
int open_lines(const std::string& path, bool append)
{
    if (!append && ::unlink(path.c_str()) != 0 && errno != ENOENT) throw WriteError(path, errno);
    const int descriptor =
        ::open(path.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK, 0666);
    if (descriptor < 0) throw WriteError(path, errno);
    struct stat status {};
    if (::fstat(descriptor, &status) == 0 && S_ISREG(status.st_mode)) return descriptor;
    ::close(descriptor);
    throw InputError({path, 0, 0, {}}, "something that is not a file", "a file or nothing");
}

}  // namespace

void EtaEstimate::add(double wall, const ProgressState& state)
{
    samples_.push_back({wall, state.time, state.residual > 0 ? std::log(state.residual) : NAN});
    if (samples_.size() > ProgressTuning::most_samples) samples_.pop_front();
}

double EtaEstimate::seconds_left() const
{
    if (samples_.size() < 2) return NAN;
    const Sample &first = samples_.front(), &last = samples_.back();
    const double wall = last.wall - first.wall;
    if (std::isfinite(end_time_)) {
        const double advance = last.time - first.time;
        return advance > 0 && wall > 0 ? std::max(0.0, end_time_ - last.time) * wall / advance : NAN;
    }
    // A least-squares line through the points (wall, log residual).
    double count = 0, sum_x = 0, sum_y = 0, sum_xx = 0, sum_xy = 0;
    for (const Sample& sample : samples_) {
        if (!std::isfinite(sample.log_residual)) continue;
        const double x = sample.wall - first.wall;
        count += 1, sum_x += x, sum_y += sample.log_residual, sum_xx += x * x, sum_xy += x * sample.log_residual;
    }
    const double spread = count * sum_xx - sum_x * sum_x;
    if (count < double(ProgressTuning::least_samples) || !(spread > 0) || !(tolerance_ > 0)) return NAN;
    const double slope = (count * sum_xy - sum_x * sum_y) / spread;
    const double fitted = sum_y / count + slope * (wall - sum_x / count);
    return slope < 0 ? std::max(0.0, (std::log(tolerance_) - fitted) / slope) : NAN;
}

ProgressReport::ProgressReport(const ProgressOptions& options)
    : options_(options), estimate_(options.end_time, options.tolerance), start_(std::chrono::steady_clock::now()),
      shown_at_(-ProgressTuning::plain_interval), terminal_(isatty(STDERR_FILENO))
{
    if (options_.path.empty()) return;
    file_ = open_lines(options_.path, options_.append);
}

ProgressReport::~ProgressReport()
{
    if (live_line_) std::fputc('\n', stderr);
    if (file_ >= 0) ::close(file_);
}

double ProgressReport::elapsed() const
{
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
}

void ProgressReport::update(const ProgressState& state)
{
    const double wall = elapsed();
    const bool phase_begins = state.phase != phase_;
    if (phase_begins) estimate_.restart();
    phase_ = state.phase;
    estimate_.add(wall, state);
    const double seconds_left = estimate_.seconds_left();
    if (file_ >= 0) write_line(state, wall, seconds_left);
    const double interval = terminal_ ? ProgressTuning::live_interval : ProgressTuning::plain_interval;
    if (options_.quiet || (!phase_begins && wall - shown_at_ < interval)) return;
    shown_at_ = wall;
    show(state, wall, seconds_left);
}

void ProgressReport::write_line(const ProgressState& state, double wall, double seconds_left)
{
    const nlohmann::ordered_json json = {{"phase", state.phase},
                                         {"time", number(state.time)},
                                         {"step", state.step},
                                         {"residual", number(state.residual)},
                                         {"left", number(state.left)},
                                         {"time_error_m", number(state.error)},
                                         {"eta_s", number(seconds_left)},
                                         {"frames", state.frames},
                                         {"wall_s", number(wall)}};
    const std::string line = json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
    // Whole lines only: readers look at the file meanwhile, and a resumed run appends to it.
    ssize_t written = ::write(file_, line.data(), line.size());
    while (written < 0 && errno == EINTR) written = ::write(file_, line.data(), line.size());
    if (written == ssize_t(line.size())) return;
    const int error = written < 0 ? errno : ENOSPC;
    if (const off_t end = ::lseek(file_, 0, SEEK_END);
        written > 0 && end >= written && ::ftruncate(file_, end - written)) {
        // The cut line stays.
    }
    throw WriteError(options_.path, error);
}

void ProgressReport::show(const ProgressState& state, double wall, double seconds_left)
{
    std::string line = fmt::format("{}  t = {:.3f} s  step {}", state.phase, state.time, state.step);
    if (std::isfinite(state.residual)) line += fmt::format("  residual {:.2e}", state.residual);
    line += "  wall " + duration(wall);
    line += "  ETA " + (std::isfinite(seconds_left) ? duration(seconds_left) : std::string("-"));
    if (terminal_) {
        std::fprintf(stderr, "\r\x1b[K%s", line.c_str());  // \x1b[K erases the rest of the old line
        live_line_ = true;
    } else {
        std::fprintf(stderr, "%s\n", line.c_str());
    }
    std::fflush(stderr);
}

void ProgressReport::clear_live_line()
{
    if (live_line_) std::fputs("\r\x1b[K", stderr);
    live_line_ = false;
}

void ProgressReport::message(const std::string& text)
{
    if (!options_.quiet) warning(text);
}

void ProgressReport::warning(const std::string& text)
{
    clear_live_line();
    std::fprintf(stderr, "%s\n", text.c_str());
}

}  // namespace selvage
