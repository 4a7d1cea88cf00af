#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "host/mannequin/mannequin_shape.hpp"

namespace selvage {
namespace {

/// The measures for which the tables below are drawn [m]. The tables were drawn
/// by hand.
const MannequinMeasures drawn = {};

/// Radii of the arm's and the leg's thick and thin end change over between
/// these shares of its length.
constexpr double knee = 0.335, thigh = 0.635;

/// Height and extent of the way from a chest that follows the bust to one that follows the shoulders [m], and how far.
constexpr std::array<double, 2> chest_top{1.16, 0.11};
constexpr double shoulder_share = 0.7;

const std::vector<TubeStation> neck_table{
    {1.340, 0, 0.036, 0.074, 0.062, 0.066}, {1.380, 0, 0.026, 0.064, 0.060, 0.060},
    {1.415, 0, 0.017, 0.056, 0.058, 0.056}, {1.452, 0, 0.009, 0.0535, 0.0555, 0.0555},
    {1.495, 0, 0.002, 0.054, 0.056, 0.056}, {1.540, 0, 0.000, 0.056, 0.057, 0.058}};

/// t is a fraction of the arm's length up to the wrist; u points backwards, v
/// outwards.
const std::vector<TubeStation> arm_table{
    {0.00, 0.000, 0, 0.0470, 0.0470, 0.0470},  {0.08, 0.000, 0, 0.0490, 0.0475, 0.0490},
    {0.20, 0.000, 0, 0.0475, 0.0455, 0.0475},  {0.35, 0.000, 0, 0.0440, 0.0425, 0.0425},
    {0.50, 0.001, 0, 0.0390, 0.0370, 0.0370},  {0.60, -0.004, 0, 0.0400, 0.0375, 0.0380},
    {0.72, -0.011, 0, 0.0370, 0.0345, 0.0345}, {0.88, -0.021, 0, 0.0295, 0.0255, 0.0255},
    {1.00, -0.027, 0, 0.0265, 0.0215, 0.0215}};

/// t is the distance beyond the wrist.
const std::vector<TubeStation> hand_table{{0.035, -0.030, 0, 0.0340, 0.0205, 0.0205},
                                          {0.075, -0.034, 0, 0.0405, 0.0215, 0.0215},
                                          {0.120, -0.038, 0, 0.0370, 0.0195, 0.0195},
                                          {0.160, -0.041, 0, 0.0270, 0.0165, 0.0165}};

const std::vector<TubeStation> thumb_table{{0.000, 0, 0, 0.0165, 0.0160, 0.0160},
                                           {0.050, 0, 0, 0.0150, 0.0145, 0.0145},
                                           {0.085, 0, 0, 0.0130, 0.0125, 0.0125}};

/// t is the height; sections below the knee scale with the stature, above with
/// the hips.
const std::vector<TubeStation> leg_table{
    {0.030, 0.110, 0.024, 0.0330, 0.0400, 0.0360},  {0.085, 0.110, 0.024, 0.0335, 0.0370, 0.0390},
    {0.160, 0.109, 0.020, 0.0385, 0.0390, 0.0450},  {0.260, 0.107, 0.012, 0.0510, 0.0460, 0.0630},
    {0.335, 0.106, 0.008, 0.0560, 0.0490, 0.0680},  {0.420, 0.103, 0.003, 0.0510, 0.0520, 0.0540},
    {0.470, 0.102, -0.002, 0.0535, 0.0580, 0.0520}, {0.530, 0.101, -0.003, 0.0600, 0.0650, 0.0600},
    {0.620, 0.098, -0.002, 0.0745, 0.0795, 0.0735}, {0.710, 0.0955, 0.001, 0.0860, 0.0890, 0.0870},
    {0.780, 0.0935, 0.005, 0.0885, 0.0900, 0.0930}, {0.850, 0.0910, 0.008, 0.0840, 0.0820, 0.0860}};

/// t runs from below the ankle to the toes, v upwards.
const std::vector<TubeStation> foot_table{
    {-0.030, 0.000, 0.018, 0.0310, 0.05, 0.042}, {0.020, 0.000, 0.018, 0.0325, 0.05, 0.062},
    {0.070, 0.000, 0.018, 0.0370, 0.05, 0.051},  {0.120, 0.003, 0.018, 0.0440, 0.05, 0.032},
    {0.160, 0.001, 0.018, 0.0425, 0.05, 0.020},  {0.185, -0.003, 0.018, 0.0350, 0.05, 0.014}};

TubeStation scaled(TubeStation s, double along, double across, double offset)
{
    s.t *= along;
    s.centre_u *= offset;
    s.centre_v *= offset;
    s.radius_u *= across;
    s.radius_low *= across;
    s.radius_high *= across;
    return s;
}

/// Girth of half an ellipse and its axis. Source: Ramanujan 1914, Modular
/// equations and approximations to pi.
double half_ellipse(double a, double b)
{
    const double h = (a - b) * (a - b) / ((a + b) * (a + b));
    return 0.5 * std::numbers::pi * (a + b) * (1 + 3 * h / (10 + std::sqrt(4 - 3 * h)));
}

double girth_of(const TubeStation& s)
{
    return half_ellipse(s.radius_u, s.radius_low) + half_ellipse(s.radius_u, s.radius_high);
}

Bump scaled(Bump bump, double across, double along, const HeightScale& heights)
{
    bump.centre = {across * bump.centre.x(), across * bump.centre.y(), heights(bump.centre.z())};
    bump.radii = {across * bump.radii.x(), across * bump.radii.y(), along * bump.radii.z()};
    bump.fillet *= along;
    return bump;
}

}  // namespace

void MannequinShape::draw()
{
    bust_ratio_ = factors_.bust * measures_.bust / figure_.bust;
    hips_ratio_ = factors_.hips * measures_.hips / figure_.hips;
    joint_ = Vec3(0.5 * measures_.shoulder_width, 0.012 * scale_, heights_(1.350));
    draw_torso();
    draw_head();
    draw_arm();
    draw_leg();
}

void MannequinShape::draw_torso()
{
    // The top of the chest widens with the shoulders, not with the bust alone.
    const double square =
        std::pow(measures_.shoulder_width / figure_.shoulder_width * figure_.bust / measures_.bust, shoulder_share);
    std::vector<TubeStation> stations;
    for (auto [section, bust, waist, hips] : figure_.torso) {
        section.radius_u *= 1 + (square - 1) * std::clamp((section.t - chest_top[0]) / chest_top[1], 0.0, 1.0);
        const double girth = bust * factors_.bust * measures_.bust + waist * factors_.waist * measures_.waist +
                             hips * factors_.hips * measures_.hips;
        stations.push_back(scaled(section, 1, girth / girth_of(section), scale_));
        stations.back().t = heights_(section.t);
    }
    torso_ = SectionTube(stations, 0.035 * scale_, 0.050 * scale_);
    chest_ = scaled(figure_.chest, bust_ratio_, scale_, heights_);
    blade_ = scaled(figure_.shoulder_blade, bust_ratio_, scale_, heights_);
    seat_ = scaled(figure_.seat, hips_ratio_, scale_, heights_);
}

void MannequinShape::draw_head()
{
    std::vector<TubeStation> stations;
    for (const TubeStation& station : neck_table) {
        stations.push_back(scaled(station, 1, factors_.neck * measures_.neck / drawn.neck, scale_));
        stations.back().t = heights_(station.t);
    }
    neck_ = SectionTube(stations, 0.04 * scale_, 0.03 * scale_);
    head_scale_ = (measures_.stature - heights_(1.476)) / 0.224;
}

void MannequinShape::draw_arm()
{
    const double length = measures_.arm_length - shoulder_to_joint * scale_;
    const double bust = measures_.bust / figure_.bust, hand = figure_.hand * scale_;
    const double upper = figure_.upper_arm * std::pow(bust, figure_.arm_growth),
                 wrist = figure_.wrist * std::pow(bust, 0.7);
    std::vector<TubeStation> stations;
    for (const TubeStation& station : arm_table)
        stations.push_back(scaled(station, length, upper + station.t * (wrist - upper), scale_));
    for (TubeStation station : hand_table) {
        station = scaled(station, hand, hand, scale_);
        station.t += length;
        stations.push_back(station);
    }
    // A hanging arm is bent outwards, which keeps it away from waist and hips, the more the wider they are.
    const double stout = std::pow(std::max(bust, measures_.hips / figure_.hips) / scale_, 3);
    const double hanging = std::clamp((measures_.arm_angle - 55) / 25, 0.0, 1.0);
    for (TubeStation& station : stations) {
        const double w = std::clamp((station.t / length - 0.05) / 0.45, 0.0, 1.0);
        station.centre_v += 0.040 * scale_ * stout * hanging * w * w * (3 - 2 * w);
    }
    hand_offset_ = stations.back().centre_v;
    arm_ = SectionTube(stations, 0.047 * upper, 0.016 * hand);
    wrist_ = length;
    stations.clear();
    for (const TubeStation& station : thumb_table) stations.push_back(scaled(station, hand, hand, hand));
    thumb_ = SectionTube(stations, 0.012 * hand, 0.010 * hand);
}

void MannequinShape::draw_leg()
{
    const double hips = measures_.hips / figure_.hips, shank = std::sqrt(scale_ * hips), foot = figure_.foot * scale_;
    std::vector<TubeStation> stations;
    for (const TubeStation& station : leg_table) {
        const double w = std::clamp((station.t - knee) / (thigh - knee), 0.0, 1.0);
        const double across = (1 - w) * shank + w * hips;
        stations.push_back(scaled(station, 1, across, (1 - w) * scale_ + w * hips));
        stations.back().t = heights_(station.t);
    }
    leg_ = SectionTube(stations, 0.02 * scale_, 0.04 * scale_);
    stations.clear();
    for (const TubeStation& station : foot_table) stations.push_back(scaled(station, foot, foot, foot));
    foot_ = SectionTube(stations, 0.024 * foot, 0.026 * foot);
}

}  // namespace selvage
