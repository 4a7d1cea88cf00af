#include "bench/accuracy/precision_front.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace selvage {
namespace {

PrecisionFront front_of(const std::vector<PrecisionPoint>& points, const std::string& scene, const std::string& method)
{
    std::vector<std::pair<double, double>> found;
    for (const PrecisionPoint& point : points)
        if (point.scene == scene && point.method == method && point.result.finished && std::isfinite(point.error))
            found.emplace_back(point.result.cpu, std::max(point.error, 1e-12));
    std::sort(found.begin(), found.end());
    PrecisionFront front{method, {}, {}};
    for (const auto& [seconds, error] : found) {
        if (!front.error.empty() && error >= front.error.back()) continue;
        front.seconds.push_back(seconds);
        front.error.push_back(error);
    }
    return front;
}

std::string winner(const std::vector<PrecisionFront>& all, double error)
{
    const PrecisionFront* best = nullptr;
    double least = 0;
    for (const PrecisionFront& front : all) {
        const auto time = time_for_error(front, error);
        if (time && (!best || *time < least)) {
            best = &front;
            least = *time;
        }
    }
    return best ? fmt::format("{} ({:.3g} s)", best->method, least) : "none";
}

}  // namespace

std::vector<PrecisionFront> fronts(const std::vector<PrecisionPoint>& points, const std::string& scene)
{
    std::vector<PrecisionFront> all;
    for (const IntegratorInfo& info : integrators())
        for (bool adaptive : {false, true}) {
            PrecisionFront front = front_of(points, scene, method_name(info.name, adaptive));
            if (!front.seconds.empty()) all.push_back(std::move(front));
        }
    return all;
}

std::optional<double> time_for_error(const PrecisionFront& front, double error)
{
    if (front.error.empty() || front.error.back() > error) return std::nullopt;
    if (front.error.front() <= error) return front.seconds.front();
    std::size_t i = 1;
    while (front.error[i] > error) ++i;
    const double part = std::log(front.error[i - 1] / error) / std::log(front.error[i - 1] / front.error[i]);
    return front.seconds[i - 1] * std::pow(front.seconds[i] / front.seconds[i - 1], part);
}

std::string verdict_sentence(const std::vector<PrecisionFront>& all, const std::string& scene,
                             const std::string& standard)
{
    std::string sentence = fmt::format("{}: fastest at 10 % error is {}, at 1 % {}, at 0.1 % {}", scene,
                                       winner(all, 0.1), winner(all, 0.01), winner(all, 0.001));
    for (const PrecisionFront& front : all)
        if (front.method == standard) {
            const auto time = time_for_error(front, 0.01);
            sentence += time ? fmt::format("; the default, {}, takes {:.3g} s to 1 %", standard, *time)
                             : fmt::format("; the default, {}, does not reach 1 %", standard);
        }
    return sentence + ".";
}

}  // namespace selvage
