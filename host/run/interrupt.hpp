#pragma once

namespace selvage {

/// Makes the signals by which a run is asked to end (SIGINT, SIGTERM), its terminal is closed (SIGHUP), its time is
/// used up (SIGXCPU) or its reader has gone (SIGPIPE) ask the run to save its state and end. A second SIGINT or SIGTERM
/// ends the program at once. The last three stay ignored if they are when the program starts, as below nohup.
void install_interrupt_handler();

/// Returns true once such a signal has come. Cheap: may be called in every iteration.
bool interrupt_requested();

/// Returns the exit code for the first signal that came, 128 + its number: 130 for SIGINT, 143 for SIGTERM; 0 if none
/// did.
int interrupt_exit_code();

}  // namespace selvage
