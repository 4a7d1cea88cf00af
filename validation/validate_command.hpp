#pragma once
#include "host/commands/command.hpp"

namespace selvage {

AddCommand add_validate_command;

}  // namespace selvage
