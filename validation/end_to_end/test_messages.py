"""What is known of a run is said: before it starts, at its end, and where it fails."""
import json
import os
import subprocess
import tempfile
import unittest

PROGRAM = os.environ.get("SELVAGE", "build/selvage")
OUTPUT = "[output]\npicture = false\n"

SHEET = """
[[sheet]]
width = 0.3
height = 0.3
resolution = 9
center = [0, 0, 0.3]
"""
TWO_IN_ONE_PLACE = 2 * SHEET + "[solver]\nuntil = 0.1\n"
ALL_HELD = """
[[sheet]]
width = 0.3
height = 0.3
resolution = 3
[pins]
vertices = "0,1,2,3,4,5,6,7,8"
[solver]
until = "equilibrium"
"""
SLIVER = """
[[sheet]]
shape = "mesh"
mesh = "sliver.obj"
center = [0, 0, 0.003]
[[sheet]]
width = 0.2
height = 0.2
resolution = 5
center = [0, 0, 0.007]
[solver]
until = 0.02
"""
SKIRT = """
[garment]
pattern = "skirt.json"
resolution = 0.06
[[body]]
name = "pole"
shape = "capsule"
radius = 0.1
center = [0, 0, 0.0]
end = [0, 0, 1.2]
[[body]]
name = "floor"
shape = "plane"
[solver]
until = "equilibrium"
"""


DRIVEN_TOGETHER = """
[[sheet]]
width = 0.2
height = 0.1
resolution = 7
center = [0, 0, 1]
[[pins.motion]]
group = "left_edge"
velocity = [0.6, 0, 0]
[[pins.motion]]
group = "right_edge"
velocity = [-0.6, 0, 0]
[solver]
until = 0.5
"""
PINCHED = """
[[sheet]]
width = 0.1
height = 0.1
resolution = 6
rotation = [90, 0, 0]
center = [0, 0, 0.4]
fabric = "denim"
[[body]]
name = "finger"
shape = "capsule"
radius = 0.01
center = [-0.02, -0.0125, 0.43]
end = [0.02, -0.0125, 0.43]
[[body.keyframe]]
time = 0.02
translation = [0, 0.0035, 0]
[[body]]
name = "thumb"
shape = "capsule"
radius = 0.01
center = [-0.02, 0.0125, 0.43]
end = [0.02, 0.0125, 0.43]
[[body.keyframe]]
time = 0.02
translation = [0, -0.0035, 0]
[solver]
until = 0.1
"""


# A sheet that a solid with sharp corners pierces: its tip is 0.1 m above the sheet.
PIERCED = """
[[sheet]]
width = 0.5
height = 0.5
resolution = 33
center = [0, 0, 0.1]
[[body]]
name = "solid"
shape = "mesh"
mesh = "solid.obj"
[solver]
until = 0.5
"""
TETRAHEDRON = """v -0.1 -0.1 0
v 0.1 -0.1 0
v 0 0.1 0
v 0 0 0.2
f 1 3 2
f 1 2 4
f 2 3 4
f 3 1 4
"""


def grid_with_sliver():
    """A square of 0.2 m with 4 x 4 cells, one of whose triangles is 0.2 mm high."""
    points = [[0.05 * column, 0.05 * row] for row in range(5) for column in range(5)]
    faces = []
    for row in range(4):
        for column in range(4):
            at = 5 * row + column
            faces += [[at, at + 1, at + 6], [at, at + 6, at + 5]]
    # A vertex just off the middle of the edge between the two triangles of the first cell.
    points.append([0.0251, 0.0249])
    faces[0:1] = [[0, 1, 25], [1, 6, 25], [0, 25, 6]]
    lines = [f"v {x} {y} 0" for x, y in points] + [f"f {a + 1} {b + 1} {c + 1}" for a, b, c in faces]
    return "\n".join(lines) + "\n"


def tube_pattern(width, height, up, depth):
    """Two rectangles sewn at both sides, in centimetres."""
    def panel(rotation, offset):
        return {"translation": [0, up, offset], "rotation": [0, rotation, 0],
                "vertices": [[-width / 2, 0], [width / 2, 0], [width / 2, height], [-width / 2, height]],
                "edges": [{"endpoints": [k, (k + 1) % 4]} for k in range(4)]}

    def seam(front, back):
        return [{"panel": "front", "edge": front}, {"panel": "back", "edge": back}]
    return json.dumps({"pattern": {"panels": {"front": panel(0, depth), "back": panel(180, -depth)},
                                   "stitches": [seam(1, 3), seam(3, 1)]},
                       "properties": {"units_in_meter": 100, "curvature_coords": "relative"}})


class Messages(unittest.TestCase):
    def drape(self, scene, *arguments, files=()):
        """Returns exit code, stderr and summary."""
        with tempfile.TemporaryDirectory() as folder:
            for name, text in dict(files, **{"scene.toml": scene + OUTPUT}).items():
                with open(os.path.join(folder, name), "w") as file:
                    file.write(text)
            out = os.path.join(folder, "out")
            result = subprocess.run([PROGRAM, "drape", os.path.join(folder, "scene.toml"), "-o", out, "--quiet",
                                     "--threads", "1", *arguments], capture_output=True, text=True)
            with open(os.path.join(out, "summary.json")) as file:
                return result.returncode, result.stderr, json.load(file)

    def test_crossings_at_the_end_of_a_timed_run_are_told(self):
        code, errors, summary = self.drape(TWO_IN_ONE_PLACE)
        self.assertEqual(code, 0)
        crossings = summary["self"]["intersections"]
        self.assertGreater(crossings, 0)
        self.assertIn(f"{crossings} pairs of the cloth's triangles intersect at the end", errors)
        self.assertTrue(any("intersect at the end" in warning for warning in summary["warnings"]))

    def test_held_vertices_that_are_driven_against_each_other_are_named(self):
        code, errors, summary = self.drape(DRIVEN_TOGETHER)
        self.assertEqual((code, summary["status"]), (3, "diverged"))
        self.assertRegex(errors, r"diverged at 0\.1\d* s \(drape\)")
        self.assertRegex(errors, r"driven against each other: vertex \d+ of `sheet\[0\]` at \(.*vertex \d+ of")
        self.assertIn("[[pins.motion]]", errors)
        self.assertIn(summary["message"], errors)

    def test_bodies_that_close_on_cloth_are_named(self):
        code, errors, _ = self.drape(PINCHED)
        self.assertEqual(code, 3)
        self.assertRegex(errors,
                         r"the bodies `(finger|thumb)` and `(?!\1)(finger|thumb)` close on the cloth between them")
        self.assertRegex(errors, r"where: vertex \d+ of `sheet\[0\]`")
        self.assertIn("contact.gap", errors)

    def test_cloth_that_cannot_be_freed_from_a_body_that_pierces_it_is_told(self):
        code, errors, summary = self.drape(PIERCED, files={"solid.obj": TETRAHEDRON})
        self.assertEqual((code, summary["status"]), (3, "diverged"))
        self.assertRegex(errors, r"likely cause: cloth is inside a body or crosses itself or a body, in \d+ vertices")
        self.assertIn("start the cloth outside the bodies", errors)

    def test_cloth_that_is_held_everywhere_is_at_rest(self):
        code, errors, summary = self.drape(ALL_HELD)
        self.assertEqual((code, summary["status"], summary["residual"]), (0, "converged", 0))
        self.assertIn("all 9 vertices are held", errors)

    def test_a_sliver_that_thins_the_contact_of_all_layers_is_named_by_drape(self):
        code, errors, summary = self.drape(SLIVER, files={"sliver.obj": grid_with_sliver()})
        self.assertEqual(code, 0)
        self.assertIn("the narrowest triangle, triangle", errors)
        self.assertIn("sliver", summary["warnings"][0])

    def test_a_garment_that_slid_to_the_floor_is_told(self):
        loose, tight = tube_pattern(60, 30, 60, 20), tube_pattern(32, 30, 60, 14)
        code, errors, summary = self.drape(SKIRT, files={"skirt.json": loose})
        self.assertEqual((code, summary["status"]), (0, "converged"))
        self.assertIn("the garment has slid off or missed its body", errors)
        self.assertTrue(any("slid off" in warning for warning in summary["warnings"]))
        code, errors, summary = self.drape(SKIRT, files={"skirt.json": tight})
        self.assertEqual(code, 0)
        self.assertNotIn("slid off", errors)

    def test_elastic_holds_a_garment_that_would_slide_off(self):
        sewn = "".join(f'[[garment.elastic]]\npanel = "{panel}"\nedges = "2"\nlength = 0.4\nstiffness = 30\n'
                       for panel in ("front", "back"))
        code, errors, summary = self.drape(SKIRT + sewn, files={"skirt.json": tube_pattern(60, 30, 60, 20)})
        self.assertEqual((code, summary["status"], summary["self"]["intersections"]), (0, "converged", 0))
        self.assertNotIn("slid off", errors)

    def test_the_largest_stretch_of_the_run_is_kept_with_its_time_and_place(self):
        code, _, summary = self.drape("""
[[sheet]]
width = 0.2
height = 0.2
resolution = 5
rotation = [90, 0, 0]
center = [0, 0, 1]
fabric = "soft"
[fabric.soft]
base = "cotton"
stretch_weft = 3
stretch_warp = 3
stretch_coupling = 0
shear = 1
damping = 0
[pins]
sheet = "top_edge"
[solver]
until = 0.5
""")
        self.assertEqual(code, 0)
        stretch = summary["stretch"]
        self.assertGreater(stretch["largest"], 1.05 * stretch["max"])   # it swings back
        self.assertTrue(0 < stretch["largest_s"] < 0.5)
        self.assertEqual(stretch["largest_panel"], "sheet[0]")
        self.assertTrue(0 <= stretch["largest_triangle"] < summary["triangles"])


if __name__ == "__main__":
    unittest.main()
