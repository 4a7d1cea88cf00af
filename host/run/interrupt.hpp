#pragma once

namespace selvage {

/// Makes SIGINT and SIGTERM ask the run to save its state and end; a second signal ends the program at once.
void install_interrupt_handler();

/// Returns true once such a signal has come. Cheap: may be called in every iteration.
bool interrupt_requested();

/// Returns the exit code for the signal that came, 128 + its number: 130 (SIGINT) or 143 (SIGTERM); 0 if none did.
int interrupt_exit_code();

}  // namespace selvage
