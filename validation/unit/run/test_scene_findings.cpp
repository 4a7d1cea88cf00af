#include "host/scene/scene_model.hpp"
#include "io/scene/read_scene.hpp"
#include "validation/unit/catch.hpp"
#include "validation/unit/scratch_file.hpp"

using namespace selvage;

namespace {

const std::string sheet = "[[sheet]]\nwidth = 0.3\nheight = 0.3\nresolution = 7\ncenter = [0, 0, 0.5]\n";
const std::string ball = "[[body]]\nshape = \"sphere\"\nradius = 0.1\n";

std::string findings(const std::string& text)
{
    const ScratchFolder folder;
    const Scene scene = read_scene(folder.write("s.toml", text), std::vector<std::string>{});
    std::string lines;
    for (const Finding& finding : build_scene_model(scene).findings)
        lines +=
            (finding.severity == Severity::note ? "note " : "warning ") + finding.kind + " " + describe(finding) + "\n";
    return lines;
}

void check_finding(const std::string& text, const std::vector<std::string>& parts)
{
    const std::string lines = findings(text);
    for (const std::string& part : parts) CHECK_THAT(lines, contains_text(part));
    CHECK(std::ranges::count(lines, '\n') == 1);
}

}  // namespace

TEST_CASE("nothing is found in ordinary scenes")
{
    CHECK(findings(sheet + ball) == "");
    CHECK(findings(sheet + ball + "center = [0.05, 0, 0]\n" + ball) == "");  // they overlap
    CHECK(findings(sheet + "[solver]\ngravity = [0, 0, 0]\n") == "");
}

TEST_CASE("gravity in another unit or direction is told")
{
    check_finding(sheet + "[solver]\ngravity = [0, 0, -981]\n",
                  {"warning gravity", "s.toml:7:", "solver.gravity", "981 m/s^2", "cm/s^2?"});
    check_finding(sheet + "[solver]\ngravity = [0, 0, -9810]\n", {"warning gravity", "mm/s^2?"});
    check_finding(sheet + "[solver]\ngravity = [0, -9.81, 0]\n", {"note gravity", "z is up"});
}

TEST_CASE("a body that stands twice, and one within another, are told")
{
    check_finding(sheet + ball + ball, {"warning body", "s.toml:9:", "`sphere_1`", "same as `sphere_0`"});
    check_finding(sheet + ball + "[[body]]\nshape = \"capsule\"\nradius = 0.02\nend = [0, 0, 0.03]\n",
                  {"warning body", "`capsule_1` lies within `sphere_0`"});
    check_finding(sheet + ball + "center = [0, 0, -1]\n[[body]]\nshape = \"plane\"\n",
                  {"warning body", "`sphere_0` lies within `plane_1`"});
}

TEST_CASE("motions that begin after the end of the run are told, and what lies beyond it is noted")
{
    const std::string keyframes =
        "[[body.keyframe]]\ntime = 2\n[[body.keyframe]]\ntime = 3\ntranslation = [0, 0, 1]\n[solver]\nuntil = ";
    check_finding(sheet + ball + keyframes + "1.5\n",
                  {"warning motion", "begins at 2 s", "ends at 1.5 s (solver.until)"});
    check_finding(sheet + ball + keyframes + "2.5\n", {"note motion", "body[0].keyframe[1].time", "at 3 s"});
    CHECK(findings(sheet + ball + keyframes + "3\n") == "");
    const std::string pins = "[[pins.motion]]\nstart = 1\nend = 2\nvelocity = [0, 0, 1]\n[solver]\nuntil = ";
    check_finding(sheet + pins + "1\n", {"warning motion", "s.toml:7:", "pins.motion[0].start", "no effect"});
    check_finding(sheet + pins + "1.5\n", {"note motion", "pins.motion[0].end"});
    check_finding(sheet + pins + "\"equilibrium\"\nmax_time = 0.5\n", {"warning motion", "(solver.max_time)"});
}

TEST_CASE("distances of contact beyond the edges, runs below a step and empty lists are told")
{
    const std::string fine = "[[sheet]]\nwidth = 0.02\nheight = 0.02\nresolution = 41\n";
    check_finding(fine + ball + "center = [0, 0, -3]\n", {"warning contact", "contact.gap", "0.002 m", "0.0005"});
    check_finding(fine + "fabric = \"f\"\n[fabric.f]\nbase = \"cotton\"\nthickness = 0.003\n",
                  {"warning contact", "s.toml:8:", "fabric.f.thickness", "0.003 m"});
    check_finding(sheet + "[solver]\nuntil = 0.001\n", {"note until", "s.toml:7:", "one step of 0.02 s"});
    check_finding("body = []\n" + sheet, {"note empty", "s.toml:1:", "body", "empty list"});
    check_finding(sheet + "[pins]\nvertices = \"\"\n", {"note empty", "pins.vertices"});
}

TEST_CASE("values of a fabric that no cloth has are told with what was found and the unit")
{
    const std::string fabric = sheet + "fabric = \"f\"\n[fabric.f]\nbase = \"cotton\"\n";
    check_finding(fabric + "areal_density = 5\n", {"warning fabric", "s.toml:9:", "fabric.f.areal_density", "kg/m^3"});
    check_finding(fabric + "thickness = 2e-5\n", {"warning fabric", "fabric.f.areal_density", "2e-05 m"});
    check_finding(fabric + "shear = 0\n", {"warning fabric", "s.toml:9:", "fabric.f.shear", "collapses"});
    check_finding(fabric + "bending_weft = 0.05\n", {"note fabric", "fabric.f.bending_weft", "9.81e-5 N m"});
    check_finding(fabric + "bending_weft = 0\nbending_warp = 0\n", {"note fabric", "no bending rigidity"});
    CHECK(findings(fabric + "friction = 0\n") == "");
}
