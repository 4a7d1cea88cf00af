"""What cannot be sewn, or not as it is meant, is refused or told before a run, and by the run itself where only that
finds out."""
import copy
import json
import os
import subprocess
import unittest

import h5py
import numpy as np

from scratch import PROGRAM, Scratch

POLE = '[[body]]\nname = "pole"\nshape = "capsule"\nradius = 0.1\ncenter = [0, 0, 0]\nend = [0, 0, 1.2]\n'


def panel(width, height, up, depth, turn=0):
    return {"translation": [0, up, depth], "rotation": [0, turn, 0],
            "vertices": [[-width / 2, 0], [width / 2, 0], [width / 2, height], [-width / 2, height]],
            "edges": [{"endpoints": [k, (k + 1) % 4]} for k in range(4)]}


def seam(a, i, b, j):
    return [{"panel": a, "edge": i}, {"panel": b, "edge": j}]


def tube(width=36, height=30, up=60, depth=14):
    """Two rectangles on either side of the pole, sewn at their sides [cm]."""
    return {"pattern": {"panels": {"front": panel(width, height, up, depth),
                                   "back": panel(width, height, up, -depth, 180)},
                        "stitches": [seam("front", 1, "back", 3), seam("front", 3, "back", 1)]},
            "properties": {"units_in_meter": 100, "curvature_coords": "relative"}}


def changed(change, **sizes):
    pattern = tube(**sizes)
    change(pattern["pattern"]["panels"], pattern["pattern"]["stitches"], pattern["properties"])
    return pattern


def cross_sides(panels, stitches, properties):
    stitches[:] = [seam("front", 1, "back", 1), seam("front", 3, "back", 3)]


def mirror(panels, stitches, properties):
    panels["back"]["vertices"] = [[-x, y] for x, y in panels["back"]["vertices"]]


def shorten(panels, stitches, properties):
    panels["back"]["vertices"] = [[x, y / 3] for x, y in panels["back"]["vertices"]]


def no_length(panels, stitches, properties):
    panels["front"]["vertices"].append(list(panels["front"]["vertices"][3]))
    panels["front"]["edges"] = [{"endpoints": [k, (k + 1) % 5]} for k in range(5)]


def tiny_dart(panels, stitches, properties):
    panels["front"]["vertices"][3:3] = [[0.05, 30], [0, 29.9], [-0.05, 30]]
    panels["front"]["edges"] = [{"endpoints": [k, (k + 1) % 7]} for k in range(7)]
    stitches[:] = [seam("front", 1, "back", 3), seam("front", 6, "back", 1), seam("front", 3, "front", 4)]


def on_top(panels, stitches, properties):
    panels["back"] = copy.deepcopy(panels["front"])


def unit(number):
    return lambda panels, stitches, properties: properties.update(units_in_meter=number)


def also_sewn(*more):
    return lambda panels, stitches, properties: stitches.append(seam(*more))


def box(size, lift=0.0, open_side=False):
    """A box of triangles [m]."""
    corners = [(x * size, y * size, z * size + lift) for z in (0, 1) for y in (0, 1) for x in (0, 1)]
    sides = [(1, 3, 4, 2), (5, 6, 8, 7), (1, 2, 6, 5), (3, 7, 8, 4), (1, 5, 7, 3), (2, 4, 8, 6)][open_side:]
    return "".join(f"v {x} {y} {z}\n" for x, y, z in corners) + "".join(f"f {a} {b} {c}\nf {a} {c} {d}\n"
                                                                       for a, b, c, d in sides)


# What is wrong, the pattern, and words of the message. Refused: exit 2.
REFUSED = [
    ("a seam twice", changed(also_sewn("front", 1, "back", 3)), "already in pattern.stitches[0]"),
    ("an edge in two seams", changed(also_sewn("front", 1, "back", 2)), "already in pattern.stitches[0]"),
    ("an edge sewn to itself", changed(also_sewn("front", 2, "front", 2)), "already in pattern.stitches[2]"),
    ("a panel that does not exist", changed(also_sewn("front", 2, "bakc", 2)), "bakc"),
    ("an edge that does not exist", changed(also_sewn("front", 2, "back", 7)), "stitches[2][1].edge: found 7"),
    ("an edge without length", changed(no_length), "edges[3].endpoints"),
    ("centimetres that say metres", changed(unit(1)), "units_in_meter"),
]
TOLD = [
    ("seams that cross", changed(cross_sides), "cross when sewn"),
    ("a seam whose sides run the wrong way", changed(lambda p, s, u: s[0].append("right_wrong")), "right_wrong"),
    ("a mirrored panel", changed(mirror), "mirrored"),
    ("sides of 1 to 3", changed(shorten), "3 to 1"),
    ("panels inside the body", tube(width=10, depth=3), "start inside a body"),
    ("panels in one place", changed(on_top), "intersect at the start"),
    ("centimetres that say millimetres", changed(unit(1000)), "units_in_meter"),
    ("a dart of a millimetre", changed(tiny_dart), "narrowest triangle"),
    ("no seam at all", changed(lambda p, s, u: s.clear()), "sewn to nothing"),
]


class BadGarments(Scratch):
    def run_scene(self, command, pattern, body=POLE, more="", *arguments):
        self.write("pattern.json", json.dumps(pattern))
        scene = self.write("scene.toml", '[garment]\npattern = "pattern.json"\nresolution = 0.04\n' + more + body +
                           "[output]\npicture = false\n")
        return subprocess.run([PROGRAM, command, scene, *arguments], capture_output=True, text=True, timeout=100)

    def test_nothing_is_said_of_a_good_one(self):
        result = self.run_scene("check", tube())
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("nothing found", result.stdout)

    def test_what_cannot_be_sewn_is_refused(self):
        for what, pattern, words in REFUSED:
            with self.subTest(what):
                for command, more in (("check", []), ("drape", ["-o", self.path("out")])):
                    result = self.run_scene(command, pattern, POLE, "", *more)
                    self.assertEqual(result.returncode, 2, result.stdout + result.stderr)
                    self.assertIn(words, result.stderr)
                self.assertFalse(os.path.exists(self.path("out")))

    def test_what_is_hardly_meant_is_told_before_the_run(self):
        for what, pattern, words in TOLD:
            with self.subTest(what):
                self.assertIn(words, self.run_scene("check", pattern).stdout)

    def test_a_garment_beside_its_body_is_told(self):
        result = self.run_scene("check", tube(), POLE, "translation = [1.5, 0, 0]\n")
        self.assertIn("falls past all bodies", result.stdout)

    def test_bodies_that_no_garment_can_be_sewn_on_are_refused(self):
        mesh = '[[body]]\nname = "b"\nmesh = "body.obj"\n'
        for what, text, words in [("centimetres", box(170), "170 m"), ("an open side", box(1, open_side=True), "hole"),
                                  ("inches for metres", box(66), "66")]:
            with self.subTest(what):
                self.write("body.obj", text)
                result = self.run_scene("check", tube(up=150), mesh)
                self.assertEqual(result.returncode, 2, result.stdout + result.stderr)
                self.assertIn(words, result.stderr)

    def test_a_tube_too_narrow_for_its_limb_names_its_open_seams(self):
        result = self.run_scene("drape", tube(width=18), POLE, "", "-o", self.path("out"), "--quiet")
        self.assertEqual(result.returncode, 4, result.stderr)
        self.assertRegex(result.stderr, r"the seam of front\[[13]\] and back\[[13]\] is still open by")
        with open(self.path("out/summary.json")) as file:
            summary = json.load(file)
        self.assertTrue(summary["seams"]["open"])
        self.assertEqual((summary["self"]["intersections"], summary["body"]["intersections"]), (0, 0))

    def test_seams_pulled_a_thousand_times_too_hard_draw_no_cloth_into_bodies(self):
        """A stiff cover that is too small for the two spheres in it: whatever it ends in, it stays outside."""
        cover = {"pattern": {"panels": {"front": panel(66, 45, 77.5, 20), "back": panel(66, 45, 77.5, -20)},
                             "stitches": [seam("front", k, "back", k) for k in range(4)]},
                 "properties": {"units_in_meter": 100, "curvature_coords": "relative"}}
        spheres = "".join(f'[[body]]\nshape = "sphere"\nradius = 0.15\ncenter = [{x}, 0, 1]\n' for x in (-0.15, 0.15))
        fabric = ("[fabric.stiff]\nareal_density = 0.2\nthickness = 0.0005\nstretch_weft = 1e6\nstretch_warp = 1e6\n"
                  "shear = 3e5\nbending_weft = 1e-5\nbending_warp = 1e-5\nfriction = 0.3\n")
        self.run_scene("drape", cover, spheres + fabric + '[seams]\nforce_limit = 1e5\n[solver]\nmax_time = 1\n',
                       'fabric = "stiff"\n', "-o", self.path("out"), "--quiet")
        with h5py.File(self.path("out/sewing.h5"), "r") as sewing:
            positions = sewing["selvage/views/positions"][:].astype(float)
        self.assertGreater(len(positions), 5)
        for centre in ((-0.15, 0, 1), (0.15, 0, 1)):
            self.assertGreater(np.linalg.norm(positions - centre, axis=-1).min(), 0.15)
        with open(self.path("out/summary.json")) as file:
            self.assertEqual(json.load(file)["body"]["max_penetration_m"], 0)


if __name__ == "__main__":
    unittest.main()
