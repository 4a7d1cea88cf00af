#pragma once

namespace selvage {

/// Opens descriptors 0, 1 and 2 where the program was started without them, so that no file of a run gets their numbers
/// and with them what is printed. What is printed there fails, as it would without a descriptor. Must come first.
void hold_standard_descriptors();

/// Brings what was printed on stdout to where it goes.
/// @returns the exit code: `code`, or, if something was lost and `code` is 0, 2 after a message on stderr
int with_results_printed(int code);

}  // namespace selvage
