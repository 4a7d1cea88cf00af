#include "host/mannequin/section_tube.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace selvage {
namespace {

using Member = double TubeStation::*;

constexpr std::array<Member, 5> shape_members{&TubeStation::centre_u, &TubeStation::centre_v, &TubeStation::radius_u,
                                              &TubeStation::radius_low, &TubeStation::radius_high};
constexpr int table_size = 193;       // Rows of the interpolation table; chosen by hand.
constexpr int smoothing_passes = 40;  // Blurs over sqrt(passes / 2) = 4.5 rows, about 2 % of the length; chosen by eye.

double secant(const std::vector<TubeStation>& s, int k, Member member)
{
    return (s[k + 1].*member - s[k].*member) / (s[k + 1].t - s[k].t);
}

/// Returns the slope at station k: the harmonic mean of the two secants, or zero at an extremum, which keeps
/// the curve monotone.
double slope(const std::vector<TubeStation>& s, int k, Member member)
{
    const int last = int(s.size()) - 1;
    if (k == 0) return secant(s, 0, member);
    if (k == last) return secant(s, last - 1, member);
    const double before = secant(s, k - 1, member), after = secant(s, k, member);
    return before * after <= 0 ? 0.0 : 2 * before * after / (before + after);
}

double interpolate(const std::vector<TubeStation>& s, int k, double t, Member member)
{
    const double width = s[k + 1].t - s[k].t;
    const double w = (t - s[k].t) / width, rest = 1 - w;
    return s[k].*member * (1 + 2 * w) * rest * rest + s[k + 1].*member * w * w * (3 - 2 * w) +
           width * w * rest * (slope(s, k, member) * rest - slope(s, k + 1, member) * w);
}

/// Smooths the table but for its ends. This removes the jumps in curvature at the stations, which are visible as bands.
void smooth(std::vector<TubeStation>& table)
{
    for (int pass = 0; pass < smoothing_passes; ++pass)
        for (Member member : shape_members) {
            double before = table.front().*member;
            for (std::size_t row = 1; row + 1 < table.size(); ++row) {
                const double here = table[row].*member;
                table[row].*member = 0.25 * (before + 2 * here + table[row + 1].*member);
                before = here;
            }
        }
}

}  // namespace

SectionTube::SectionTube(const std::vector<TubeStation>& stations, double cap_first, double cap_last)
    : table_(table_size), first_(stations.front().t), last_(stations.back().t),
      per_length_((table_size - 1) / (stations.back().t - stations.front().t)), cap_first_(cap_first),
      cap_last_(cap_last)
{
    int k = 0;
    for (int row = 0; row < table_size; ++row) {
        const double t = first_ + row / per_length_;
        while (k + 2 < int(stations.size()) && t > stations[k + 1].t) ++k;
        table_[row].t = t;
        for (Member member : shape_members) table_[row].*member = interpolate(stations, k, t, member);
    }
    smooth(table_);
}

TubeStation SectionTube::section(double t) const
{
    const double at = (std::clamp(t, first_, last_) - first_) * per_length_;
    const int row = std::min(int(at), table_size - 2);
    const double w = at - row;
    TubeStation result;
    result.t = t;
    for (Member member : shape_members) result.*member = (1 - w) * table_[row].*member + w * table_[row + 1].*member;
    return result;
}

double SectionTube::distance(double t, double u, double v) const
{
    const TubeStation s = section(t);
    const double du = u - s.centre_u, dv = v - s.centre_v, dt = t < first_ ? t - first_ : std::max(t - last_, 0.0);
    const double radius_v = dv < 0 ? s.radius_low : s.radius_high, cap = t < first_ ? cap_first_ : cap_last_;
    const double a = du / s.radius_u, b = dv / radius_v, c = dt / cap;
    const double k0 = std::sqrt(a * a + b * b + c * c);
    if (k0 < 1e-9) return -std::min(s.radius_u, radius_v);
    const double a1 = a / s.radius_u, b1 = b / radius_v, c1 = c / cap;
    return k0 * (k0 - 1) / std::sqrt(a1 * a1 + b1 * b1 + c1 * c1);
}

}  // namespace selvage
