#pragma once
#include <string>

namespace selvage {

/// Draws a frame of a run.h5 with the body.obj beside it, if there is one.
/// @param frame  from 0; negative: counted from the end
/// @param width  of the picture [pixels]
/// @throws InputError if the file is no run or has no such frame
void render_run(const std::string& run_h5, const std::string& png, int frame, int width);

}  // namespace selvage
