#pragma once
#include <functional>

namespace CLI {
class App;
}

namespace selvage {

/// What the command line asks for; returns the exit code.
using Action = std::function<int()>;

/// Adds one subcommand with its options and its help; when the command line names it, `chosen` becomes its action.
using AddCommand = void(CLI::App& program, Action& chosen);

}  // namespace selvage
