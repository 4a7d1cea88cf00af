#include <algorithm>
#include <cmath>

#include "host/mannequin/mannequin_shape.hpp"

namespace selvage {
namespace {

/// The measures for which the tables below are drawn [m]. The tables were drawn by hand.
const MannequinMeasures drawn = {};

/// A torso section and the weights with which the bust, waist and hip girths scale it; the weights sum to 1.
struct TorsoStation {
    TubeStation section;
    double bust = 0, waist = 0, hips = 0;
};

const std::vector<TorsoStation> torso_table{
    {{0.795, 0, 0.016, 0.095, 0.054, 0.072}, 0, 0, 1},     {{0.835, 0, 0.012, 0.150, 0.086, 0.094}, 0, 0, 1},
    {{0.875, 0, 0.009, 0.170, 0.103, 0.105}, 0, 0, 1},     {{0.930, 0, 0.006, 0.166, 0.109, 0.102}, 0, 0.2, 0.8},
    {{1.000, 0, 0.003, 0.142, 0.108, 0.091}, 0, 0.7, 0.3}, {{1.065, 0, 0.002, 0.121, 0.100, 0.089}, 0, 1, 0},
    {{1.120, 0, 0.006, 0.127, 0.103, 0.098}, 0.3, 0.7, 0}, {{1.175, 0, 0.012, 0.140, 0.109, 0.108}, 0.8, 0.2, 0},
    {{1.215, 0, 0.016, 0.147, 0.110, 0.113}, 1, 0, 0},     {{1.270, 0, 0.020, 0.152, 0.101, 0.113}, 1, 0, 0},
    {{1.320, 0, 0.024, 0.147, 0.083, 0.104}, 1, 0, 0},     {{1.360, 0, 0.026, 0.125, 0.069, 0.086}, 1, 0, 0}};

const std::vector<TubeStation> neck_table{
    {1.340, 0, 0.036, 0.074, 0.062, 0.066}, {1.380, 0, 0.026, 0.064, 0.060, 0.060},
    {1.415, 0, 0.017, 0.056, 0.058, 0.056}, {1.452, 0, 0.009, 0.0535, 0.0555, 0.0555},
    {1.495, 0, 0.002, 0.054, 0.056, 0.056}, {1.540, 0, 0.000, 0.056, 0.057, 0.058}};

/// t is a fraction of the arm's length up to the wrist; u points backwards, v outwards.
const std::vector<TubeStation> arm_table{
    {0.00, 0.000, 0, 0.0470, 0.0470, 0.0470},  {0.08, 0.000, 0, 0.0490, 0.0475, 0.0490},
    {0.20, 0.000, 0, 0.0475, 0.0455, 0.0475},  {0.35, 0.000, 0, 0.0440, 0.0425, 0.0425},
    {0.50, 0.001, 0, 0.0390, 0.0370, 0.0370},  {0.60, -0.004, 0, 0.0400, 0.0375, 0.0380},
    {0.72, -0.011, 0, 0.0370, 0.0345, 0.0345}, {0.88, -0.021, 0, 0.0295, 0.0255, 0.0255},
    {1.00, -0.027, 0, 0.0265, 0.0215, 0.0215}};

/// t is the distance beyond the wrist.
const std::vector<TubeStation> hand_table{{0.035, -0.030, 0, 0.0340, 0.0185, 0.0185},
                                          {0.075, -0.034, 0, 0.0420, 0.0175, 0.0175},
                                          {0.120, -0.038, 0, 0.0385, 0.0150, 0.0150},
                                          {0.160, -0.041, 0, 0.0290, 0.0120, 0.0120}};

const std::vector<TubeStation> thumb_table{{0.000, 0, 0, 0.0150, 0.0145, 0.0145},
                                           {0.045, 0, 0, 0.0135, 0.0130, 0.0130},
                                           {0.075, 0, 0, 0.0115, 0.0110, 0.0110}};

/// t is the height; sections below the knee scale with the stature, above with the hips.
const std::vector<TubeStation> leg_table{
    {0.030, 0.110, 0.024, 0.0330, 0.0400, 0.0360},  {0.085, 0.110, 0.024, 0.0335, 0.0370, 0.0390},
    {0.160, 0.109, 0.020, 0.0385, 0.0390, 0.0450},  {0.260, 0.107, 0.012, 0.0510, 0.0460, 0.0630},
    {0.335, 0.106, 0.008, 0.0560, 0.0490, 0.0680},  {0.420, 0.103, 0.003, 0.0510, 0.0520, 0.0540},
    {0.470, 0.102, -0.002, 0.0535, 0.0580, 0.0520}, {0.530, 0.101, -0.003, 0.0600, 0.0650, 0.0600},
    {0.620, 0.098, -0.002, 0.0720, 0.0780, 0.0720}, {0.710, 0.0955, 0.001, 0.0820, 0.0860, 0.0840},
    {0.780, 0.0925, 0.005, 0.0845, 0.0870, 0.0900}, {0.850, 0.0880, 0.008, 0.0790, 0.0760, 0.0810}};

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

}  // namespace

void MannequinShape::draw()
{
    scale_ = measures_.stature / drawn.stature;
    // Arms grow more slowly than the bust.
    arm_scale_ = std::pow(measures_.bust / drawn.bust, 0.8);
    joint_ = Vec3(factors_.joint_x, 0.012 * scale_, 1.350 * scale_);
    draw_torso();
    draw_head();
    draw_arm();
    draw_leg();
}

void MannequinShape::draw_torso()
{
    std::vector<TubeStation> stations;
    for (const auto& [section, bust, waist, hips] : torso_table) {
        const double across = bust * factors_.bust * measures_.bust / drawn.bust +
                              waist * factors_.waist * measures_.waist / drawn.waist +
                              hips * factors_.hips * measures_.hips / drawn.hips;
        stations.push_back(scaled(section, scale_, across, scale_));
    }
    torso_ = SectionTube(stations, 0.035 * scale_, 0.060 * scale_);
}

void MannequinShape::draw_head()
{
    std::vector<TubeStation> stations;
    for (const TubeStation& station : neck_table)
        stations.push_back(scaled(station, scale_, factors_.neck * measures_.neck / drawn.neck, scale_));
    neck_ = SectionTube(stations, 0.04 * scale_, 0.03 * scale_);
}

void MannequinShape::draw_arm()
{
    const double length = measures_.arm_length;
    std::vector<TubeStation> stations;
    for (const TubeStation& station : arm_table) stations.push_back(scaled(station, length, arm_scale_, scale_));
    for (TubeStation station : hand_table) {
        station = scaled(station, scale_, scale_, scale_);
        station.t += length;
        stations.push_back(station);
    }
    // A hanging arm is bent outwards, which keeps it away from waist and hips.
    const double hanging = std::clamp((measures_.arm_angle - 55) / 25, 0.0, 1.0);
    for (TubeStation& station : stations) {
        const double w = std::clamp((station.t / length - 0.05) / 0.45, 0.0, 1.0);
        station.centre_v += 0.040 * scale_ * hanging * w * w * (3 - 2 * w);
    }
    hand_offset_ = stations.back().centre_v;
    arm_ = SectionTube(stations, 0.047 * arm_scale_, 0.016 * scale_);
    stations.clear();
    for (const TubeStation& station : thumb_table) stations.push_back(scaled(station, scale_, scale_, scale_));
    thumb_ = SectionTube(stations, 0.012 * scale_, 0.010 * scale_);
}

void MannequinShape::draw_leg()
{
    const double hips = factors_.hips * measures_.hips / drawn.hips;
    std::vector<TubeStation> stations;
    for (const TubeStation& station : leg_table) {
        const double w = std::clamp((station.t - 0.335) / 0.3, 0.0, 1.0);
        stations.push_back(scaled(station, scale_, (1 - w) * scale_ + w * hips, (1 - w) * scale_ + w * hips));
    }
    leg_ = SectionTube(stations, 0.02 * scale_, 0.04 * scale_);
    stations.clear();
    for (const TubeStation& station : foot_table) stations.push_back(scaled(station, scale_, scale_, scale_));
    foot_ = SectionTube(stations, 0.024 * scale_, 0.026 * scale_);
}

}  // namespace selvage
