#pragma once
#include "host/commands/command.hpp"

namespace selvage {

/// Adds `selvage bench SUITE` to the program's commands.
AddCommand add_bench_command;

}  // namespace selvage
