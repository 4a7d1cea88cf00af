#pragma once
#include <array>
#include <string>
#include <vector>

#include "io/run/trajectory.hpp"

namespace selvage {

/// The edges at which two triangles are sewn to each other: those whose ends lie in two places of the flat cloth.
/// Files of earlier versions do not tell the places; then it is the edges between two panels.
std::vector<std::array<int, 2>> seam_edges(const TrajectoryLayout& layout);

/// Draws a frame of a run.h5 or sewing.h5 with its bodies: those of the body.obj beside it, or, if they move, those
/// that the run's scene has at that time.
/// @param frame  from 0; negative: counted from the end
/// @param width  of the picture [pixels]
/// @param body_obj  when not empty, the bodies are written there as well
/// @throws InputError if the file is no run or has no such frame
void render_run(const std::string& run_h5, const std::string& png, int frame, int width,
                const std::string& body_obj = {});

}  // namespace selvage
