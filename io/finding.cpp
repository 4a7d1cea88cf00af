#include "io/finding.hpp"

#include "io/utf8.hpp"

namespace selvage {

std::string describe(const Finding& finding)
{
    const std::string place = describe(finding.place);
    std::string text = place + (place.empty() ? "" : ": ") + finding.text;
    if (!finding.way_on.empty()) text += "; " + finding.way_on;
    return valid_utf8(text);
}

void append_findings(std::vector<Finding>& to, const std::vector<Finding>& from)
{
    to.insert(to.end(), from.begin(), from.end());
}

}  // namespace selvage
