#pragma once
#include <array>
#include <string>
#include <vector>

#include "io/errors.hpp"
#include "io/words.hpp"

namespace selvage {

/// How much a finding matters: worth knowing though nothing is wrong; a result that may not be what was meant; a run
/// that cannot end well.
#define SEVERITIES(WORD) WORD(note) WORD(warning) WORD(fault)
WORD_ENUM(Severity, SEVERITIES)

/// Something that was found while input was examined. Where a run cannot even start, an InputError is thrown instead.
struct Finding {
    std::string kind;                         ///< One word for programs, such as `unit` or `self_intersection`.
    InputPlace place;                         ///< Where in the user's input.
    std::string text;                         ///< What was found, with vertex, piece and size.
    std::string way_on = {};                  ///< What the user can do, with the key or the edit; may be empty.
    Severity severity = Severity::warning;    ///< How much it matters.
    std::vector<int> faces = {};              ///< Triangles of the cloth that are involved, for pictures.
    std::vector<std::array<int, 2>> pairs{};  ///< Pairs of triangles that intersect.
};

/// Returns a finding as one line: place, text and way on.
std::string describe(const Finding& finding);

/// Appends the findings of one list to another.
void append_findings(std::vector<Finding>& to, const std::vector<Finding>& from);

}  // namespace selvage
