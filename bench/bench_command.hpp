#pragma once
#include "host/commands/command.hpp"

namespace selvage {

AddCommand add_bench_command;

}  // namespace selvage
