#pragma once
#include <iosfwd>
#include <string>
#include <vector>

namespace selvage {

/// Dresses bodies with patterns of a folder or a manifest, each in a process of its own, and prints a table: did it
/// converge, is it joined, does anything intersect, how far is it stretched, how long did it take.
/// Options: `--manifest FILE` or `--patterns FOLDER --body FILE[,FILE]`, `--only WORD[,WORD]`, `--resolution M`,
/// `--limit SECONDS`, `--up AXIS`, `--set KEY=VALUE[,KEY=VALUE]`, `--output FOLDER` (default bench-out).
/// Writes garments.json and garments.png, a contact sheet of all rows, there.
/// @throws InputError for a bad option, a bad manifest or a folder that cannot be written
void bench_garments(bool json, const std::vector<std::string>& options, std::ostream& out);

}  // namespace selvage
