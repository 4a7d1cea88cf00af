"""`measure` finds parts, landmarks and measures of bodies in files, and refuses what is no body."""
import json
import math
import os
import subprocess
import unittest

from scratch import Scratch
from sources import ROOT

PROGRAM = os.environ.get("SELVAGE", "build/selvage")
# Bodies that others made and measured; they are no part of the project.
BODIES = os.environ.get("SELVAGE_BODIES", str(ROOT.parent / "shared/data/bodies"))
# A grain of cloth above the mannequin, for a moment: what leaves the mannequin as a file soonest.
SCENE = """
[[sheet]]
width = 0.1
height = 0.1
resolution = 3
fabric = "linen"
center = [0, 0, 2]
[[body]]
shape = "mannequin"
[solver]
until = 0.01
[output]
picture = false
"""


def call(*arguments):
    return subprocess.run([PROGRAM, *arguments], capture_output=True, text=True, timeout=120)


def measured(*arguments):
    result = call("measure", *arguments, "--json")
    if result.returncode != 0:
        raise AssertionError(result.stderr)
    return json.loads(result.stdout)


def vertices_and_rest(path):
    with open(path) as file:
        lines = file.read().splitlines()
    points = [[float(word) for word in line.split()[1:4]] for line in lines if line.startswith("v ")]
    return points, [line for line in lines if not line.startswith("v ")]


def obj(points, rest):
    return ["v " + " ".join(f"{x:.7g}" for x in point) for point in points] + rest


class Measure(Scratch):
    def test_the_built_in_mannequin_has_the_measures_that_it_was_asked_for(self):
        told = measured("builtin:mannequin", "--set", "body[0].bust=1.0", "--set", "body[0].hips=1.1")
        for name, asked in (("bust", 1.0), ("waist", 0.74), ("hips", 1.1)):
            self.assertAlmostEqual(told["girths_m"][name] / asked, 1, delta=0.01)
        self.assertAlmostEqual(told["height_m"], 1.7, delta=0.005)
        self.assertEqual(sum(told["part_vertices"].values()), len(told["parts"]))
        self.assertLess({"neck", "bust", "waist", "hips", "thigh", "upper_arm", "wrist"}, set(told["girths_m"]))
        self.assertEqual(set(told["girths_m"]) | set(told["lengths_m"]), set(told["measured"]))
        plain = call("measure", "builtin:mannequin")
        self.assertRegex(plain.stdout, r"\n  waist +74\.\d  narrowest of the trunk")

    def test_a_file_in_another_unit_with_another_axis_up_and_another_front_has_the_same_measures(self):
        scene = self.write("scene.toml", SCENE)
        self.assertEqual(call("drape", scene, "-o", self.path("out")).returncode, 0)
        points, rest = vertices_and_rest(self.path("out/body.obj"))
        before = measured(self.path("out/body.obj"))
        cosine, sine = math.cos(2), math.sin(2)
        turned = [[cosine * x - sine * y, sine * x + cosine * y, z] for x, y, z in points]
        other = self.write("other.obj", obj([[100 * x, 100 * z, -100 * y] for x, y, z in turned], rest))
        picture = self.path("body.png")
        after = measured(other, "--unit", "cm", "--up", "y", "-o", picture)
        self.assertGreater(os.path.getsize(picture), 10000)
        for list_name in ("girths_m", "lengths_m"):
            for name, value in before[list_name].items():
                self.assertAlmostEqual(after[list_name][name] / value, 1, delta=0.01, msg=name)
        for name, (x, y, z) in before["landmarks"].items():
            expected = [cosine * x - sine * y, sine * x + cosine * y, z]
            self.assertLess(math.dist(after["landmarks"][name], expected), 0.015, name)
        same = sum(a == b for a, b in zip(before["parts"], after["parts"]))
        self.assertGreater(same, 0.995 * len(points))
        for arguments, message in (((other, "--up", "y"), "a body 170 m high"),
                                   ((self.path("out/body.obj"), "--up", "y"), "--up x or --up z if that is up")):
            refused = call("measure", *arguments)
            self.assertEqual((refused.returncode, refused.stdout), (2, ""))
            self.assertIn(message, refused.stderr)

    def test_what_is_no_body_is_refused(self):
        corners = [[x, y, z] for x in (0, 0.5) for y in (0, 0.5) for z in (0, 1.0)]
        box = obj(corners, ["f 1 2 4 3", "f 5 7 8 6", "f 1 5 6 2", "f 3 4 8 7", "f 1 3 7 5", "f 2 6 8 4"])
        ball = self.write("ball.toml", '[[sheet]]\nresolution = 5\n[[body]]\nshape = "sphere"\nradius = 0.5\n')
        bare = self.write("bare.toml", "[[sheet]]\nresolution = 5\n")
        for arguments, message in (((self.write("box.obj", box),), "a body has 4"), ((ball,), "a body has 4"),
                                   ((bare,), "a scene without bodies"), ((self.path("none.obj"),), "none.obj"),
                                   ((self.path("box.obj"), "--set", "body[0].size=L"), "--set with a mesh"),
                                   ((self.path("box.obj"), "--unit", "ell"), "ell")):
            refused = call("measure", *arguments)
            self.assertEqual((refused.returncode, refused.stdout), (2, ""), arguments)
            self.assertIn(message, refused.stderr)

    @unittest.skipUnless(os.path.isdir(BODIES), f"no bodies in {BODIES}")
    def test_bodies_of_others_have_the_measures_and_parts_that_come_with_them(self):
        with open(os.path.join(BODIES, "ggg_body_segmentation.json")) as file:
            segments = json.load(file)
        limbs = {"arm": "arm", "hand": "arm", "leg": "leg", "foot": "leg"}
        for name, tolerance in (("mean_all", 0.02), ("mean_female", 0.02), ("mean_all_tpose", 0.02)):
            told = measured(os.path.join(BODIES, name + ".obj"), "--up", "y")
            with open(os.path.join(BODIES, name.removesuffix("_tpose") + ".yaml")) as file:
                given = dict(line.split(":") for line in file if ": " in line)
            known = {key.strip(): float(value) / 100 for key, value in given.items()}
            for ours, theirs in (("bust", "bust"), ("underbust", "underbust"), ("waist", "waist"), ("hips", "hips"),
                                 ("thigh", "leg_circ")):
                self.assertAlmostEqual(told["girths_m"][ours] / known[theirs], 1, delta=tolerance, msg=ours)
            right = 0
            for segment, vertices in segments.items():
                for vertex in vertices:
                    side, _, part = told["parts"][vertex].partition("_")
                    found = f"{side}_{limbs[part]}" if part in limbs else "body"
                    right += found == ("body" if segment == "face_internal" else segment)
            self.assertGreater(right, 0.95 * sum(map(len, segments.values())), name)


if __name__ == "__main__":
    unittest.main()
