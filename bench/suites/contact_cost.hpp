#pragma once
#include <iosfwd>
#include <string>
#include <vector>

namespace selvage {

/// Runs scenes in which cloth touches itself, each in a process of its own with one thread, and prints what contact of
/// the cloth with itself cost in them: processor time, searches for all corners and for some, and pairs measured. With
/// another program, such as the build of an earlier version, both run in turn and the ratios are printed.
/// Options: --scene NAME, --repeats N, --program FILE, --against FILE.
/// @throws InputError for a bad option
void bench_contact(bool json, const std::vector<std::string>& options, std::ostream& out);

}  // namespace selvage
