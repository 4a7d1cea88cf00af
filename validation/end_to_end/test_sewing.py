"""Panels are sewn around bodies: over what stands between them, again and again resumed, and as far as they close."""
import json
import math
import os
import subprocess
import unittest

import h5py
import numpy as np

from scratch import Scratch

PROGRAM = os.environ.get("SELVAGE", "build/selvage")
RADIUS, LENGTH, AROUND, RINGS = 0.06, 0.4, 32, 21   # of a bar along the x axis
WIDTH, HEIGHT = 0.12, 0.15                          # of a panel


def bar():
    """A closed tube along the x axis, 1 m up."""
    lines, faces = [], []
    for ring in range(RINGS):
        for k in range(AROUND):
            angle = 2 * math.pi * k / AROUND
            lines.append("v %.6f %.6f %.6f" % (LENGTH * (ring / (RINGS - 1) - 0.5), RADIUS * math.cos(angle),
                                               1 + RADIUS * math.sin(angle)))
    lines += ["v %g 0 1" % (-LENGTH / 2), "v %g 0 1" % (LENGTH / 2)]
    first, last = RINGS * AROUND + 1, RINGS * AROUND + 2
    for k in range(AROUND):
        after = (k + 1) % AROUND
        end = (RINGS - 1) * AROUND
        faces += [(first, after + 1, k + 1), (last, end + k + 1, end + after + 1)]
        for ring in range(RINGS - 1):
            a, b = ring * AROUND + k + 1, ring * AROUND + after + 1
            faces += [(a, b, b + AROUND), (a, b + AROUND, a + AROUND)]
    return lines + ["f %d %d %d" % face for face in faces]


def panels(top, away):
    """Two panels that hang before and behind the bar and are sewn along their upper edges. [m]"""
    rectangle = [[-WIDTH / 2, 0], [WIDTH / 2, 0], [WIDTH / 2, HEIGHT], [-WIDTH / 2, HEIGHT]]
    edges = [{"endpoints": [k, (k + 1) % 4]} for k in range(4)]
    # The back is turned about the vertical axis, so that its outside is outside as well.
    return {"pattern": {
        "panels": {name: {"vertices": rectangle, "edges": edges, "translation": [0, top - HEIGHT, place],
                          "rotation": [0, turn, 0]}
                   for name, place, turn in [("front", away, 0), ("back", -away, 180)]},
        "stitches": [[{"panel": "front", "edge": 2}, {"panel": "back", "edge": 2}]]},
        "properties": {"units_in_meter": 1}}


class Sewing(Scratch):
    def scene(self, top, away, until='"equilibrium"', more=()):
        self.write("bar.obj", bar())
        self.write("panels.json", json.dumps(panels(top, away), indent=1))
        return self.write("scene.toml", [
            'summary = "panels over a bar"', "[garment]", 'pattern = "panels.json"', "resolution = 0.02", "[[body]]",
            'shape = "mesh"', 'mesh = "bar.obj"', "[solver]", f"until = {until}", "[output]", "picture = false",
            'precision = "lossless"', *more])

    def drape(self, scene, folder, *options):
        return subprocess.run([PROGRAM, "drape", scene, "-o", self.path(folder), "--quiet", *options],
                              capture_output=True, text=True, timeout=200)

    def summary(self, folder):
        with open(os.path.join(self.path(folder), "summary.json")) as file:
            return json.load(file)

    def frames(self, folder, name):
        with h5py.File(os.path.join(self.path(folder), name), "r") as file:
            return file["selvage/positions"][:]

    def test_a_seam_closes_over_what_stands_between_its_sides(self):
        result = self.drape(self.scene(top=1.04, away=0.1), "out")
        self.assertEqual(result.returncode, 0, result.stderr)
        found = self.summary("out")
        self.assertEqual((found["status"], found["seams"]["max_gap_m"], found["seams"]["open"]), ("converged", 0, []))
        self.assertEqual((found["self"]["intersections"], found["body"]["intersections"]), (0, 0))
        self.assertIn("thin_bodies", found["active"])
        self.assertLess(found["stretch"]["p99"], 0.03)
        end = self.frames("out", "run.h5")[-1]
        self.assertGreater(end[:, 2].max(), 1 + RADIUS)     # it lies on the bar

    def test_bodies_keep_their_size_where_nothing_stands_between(self):
        result = self.drape(self.scene(top=1.1, away=0.1), "out")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertNotIn("thin_bodies", self.summary("out")["active"])
        reason = [part["reason"] for part in self.summary("out")["skipped"] if part["name"] == "thin_bodies"]
        self.assertIn("no body stands between the sides of a seam", reason[0])

    def test_a_run_stopped_again_and_again_while_it_sews_and_bodies_grow_goes_on_exactly(self):
        scene = self.scene(top=1.04, away=0.1, until="0.1")
        self.assertEqual(self.drape(scene, "whole").returncode, 0)
        stops = 0
        code = self.drape(scene, "parts", "--set", "solver.max_wall=0.1").returncode
        while code == 4 and stops < 100:
            stops += 1
            code = self.drape(scene, "parts", "--set", "solver.max_wall=0.1", "--resume").returncode
        self.assertEqual(code, 0)
        self.assertGreater(stops, 3)
        for name in ["sewing.h5", "run.h5"]:
            np.testing.assert_array_equal(self.frames("whole", name)[-1], self.frames("parts", name)[-1])

    def test_the_same_garment_is_sewn_the_same_way(self):
        scene = self.scene(top=1.04, away=0.1, until="0.05")
        for folder in ["one", "other"]:
            self.assertEqual(self.drape(scene, folder).returncode, 0)
        for name in ["sewing.h5", "run.h5"]:
            np.testing.assert_array_equal(self.frames("one", name), self.frames("other", name))

    def test_a_seam_that_does_not_close_is_named_and_the_rest_is_draped(self):
        scene = self.scene(top=1.04, away=0.1, until="0.1", more=["[seams]", "max_time = 0.04", "force_limit = 0.001"])
        result = self.drape(scene, "out")
        self.assertEqual(result.returncode, 4, result.stderr)
        found = self.summary("out")
        self.assertEqual(found["status"], "time_limit")
        seam = found["seams"]["open"][0]
        self.assertEqual(seam["sides"], ["front[2]", "back[2]"])
        self.assertIn("panels.json:", seam["place"])
        self.assertAlmostEqual(seam["gap_m"], found["seams"]["max_gap_m"])
        for text in ["the seam of front[2] and back[2] is still open by", "panels.json:", "pattern.stitches[0]"]:
            self.assertIn(text, result.stderr)
            self.assertIn(text, found["message"])
        self.assertGreater(len(self.frames("out", "run.h5")), 1)


if __name__ == "__main__":
    unittest.main()
