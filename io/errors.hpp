#pragma once
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

namespace selvage {

/// The place of a fault in the user's input; empty members are left out of the message.
struct InputPlace {
    std::string file;  ///< Path as the user gave it.
    int line = 0;      ///< From 1; 0 if unknown.
    int column = 0;    ///< From 1; 0 if unknown.
    std::string key;   ///< Key path such as `solver.step` or `pattern.panels.front.edges[3]`.
};

/// Returns a place as `file:line:column: key`, without the parts that are not known.
std::string describe(const InputPlace& place);

/// Bad usage or input: the program ends with exit code 2 and this message.
class InputError : public std::runtime_error {
public:
    /// @param place     where the fault lies
    /// @param found     the value or state that was found, as the user would recognise it
    /// @param expected  what would have been accepted, with its unit
    /// @param nearest   a valid name close to the one found, or empty
    InputError(const InputPlace& place, std::string_view found, std::string_view expected,
               std::string_view nearest = {});
};

/// The run diverged and no smaller step helped: exit code 3, the last good state is saved.
class DivergenceError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// Returns the candidate with the smallest edit distance to `name`, or "" if none is close.
std::string nearest_name(std::string_view name, std::span<const std::string> candidates);

}  // namespace selvage
