"""Runs with bodies and pins that move: what is written, what --resume goes on from, and what check finds crossed."""
import json
import os
import subprocess
import tempfile
import unittest

import h5py
import numpy as np

PROGRAM = os.environ.get("SELVAGE", "build/selvage")
LIFT = """
[[sheet]]
width = 0.3
height = 0.3
resolution = 13
center = [0, 0, 0.106]

[[body]]
name = "ball"
shape = "sphere"
radius = 0.1
interpolation = "smooth"
[[body.keyframe]]
time = 0.4
translation = [0, 0, 0.1]
rotation = [0, 0, 90]
[[body.keyframe]]
time = 0.6
translation = [0.02, 0, 0.1]

[[pins.motion]]
group = "left_edge"
end = 0.5
velocity = [0, 0, 0.2]
"""
CROSSED = """
[[sheet]]
resolution = 5
center = [0, 0, 1]
[[sheet]]
resolution = 5
center = [0, 0, 1.01]
rotation = [20, 10, 0]
[[body]]
name = "pole"
shape = "cone"
radius = 0.02
height = 3
"""


def run(*arguments):
    return subprocess.run([PROGRAM, *arguments], capture_output=True, text=True, timeout=120)


def summary_of(folder):
    with open(os.path.join(folder, "summary.json")) as file:
        return json.load(file)


def positions(folder):
    with h5py.File(os.path.join(folder, "run.h5"), "r") as file:
        return file["selvage/positions"][-1].astype(float)


def obj_vertices(path):
    with open(path) as file:
        return np.array([[float(x) for x in line.split()[1:4]] for line in file if line.startswith("v ")])


class Moving(unittest.TestCase):
    def setUp(self):
        holder = tempfile.TemporaryDirectory()
        self.addCleanup(holder.cleanup)
        self.folder = holder.name

    def write(self, name, text):
        with open(os.path.join(self.folder, name), "w") as file:
            file.write(text)
        return os.path.join(self.folder, name)

    def drape(self, scene, name, *more):
        folder = os.path.join(self.folder, name)
        result = run("drape", scene, "-o", folder, "--quiet", "--threads", "1", "--set", "output.picture=false",
                     "--set", "contact.self=false", *more)   # what is looked at here is the motion of bodies and pins
        self.assertEqual(result.returncode, 0, result.stderr)
        return folder

    def test_a_resumed_run_arrives_where_an_uninterrupted_one_does(self):
        scene = self.write("lift.toml", LIFT)
        whole = self.drape(scene, "whole", "--set", "solver.until=0.7")
        part = self.drape(scene, "part", "--set", "solver.until=0.3", "--set", "output.keep_checkpoint=true")
        self.drape(scene, "part", "--set", "solver.until=0.7", "--resume")
        self.assertTrue(np.array_equal(positions(whole), positions(part)))

    def test_the_written_body_is_that_of_the_last_frame(self):
        scene = self.write("lift.toml", LIFT)
        folder = self.drape(scene, "out", "--set", "solver.until=0.5")
        ball = obj_vertices(os.path.join(folder, "body.obj"))
        middle = 0.5 * (ball.min(axis=0) + ball.max(axis=0))
        self.assertLess(np.abs(middle - [0.01, 0, 0.1]).max(), 1e-3, middle)
        summary = summary_of(folder)
        self.assertEqual(summary["body"]["intersections"], 0)
        self.assertEqual(summary["body"]["max_penetration_m"], 0)
        self.assertIn("body_motion", summary["active"])
        self.assertIn("pin_motion", summary["active"])

    def test_a_picture_of_a_frame_shows_the_bodies_of_that_frame(self):
        folder = self.drape(self.write("lift.toml", LIFT), "out", "--set", "solver.until=0.5")
        bodies = os.path.join(self.folder, "bodies.obj")
        result = run("render", os.path.join(folder, "run.h5"), "--frame", "6", "--width", "64", "--bodies", bodies,
                     "-o", os.path.join(self.folder, "frame.png"))
        self.assertEqual(result.returncode, 0, result.stderr)
        ball = obj_vertices(bodies)   # at half the time to the first keyframe, half the way
        self.assertAlmostEqual(0.5 * (ball[:, 2].min() + ball[:, 2].max()), 0.05, delta=1e-3)

    def test_equilibrium_is_that_after_the_last_keyframe(self):
        folder = self.drape(self.write("lift.toml", LIFT), "out", "--set", "solver.until=equilibrium")
        summary = summary_of(folder)
        self.assertEqual(summary["status"], "converged")
        self.assertGreaterEqual(summary["simulated_s"], 0.6 - 1e-9)

    def test_what_stands_still_is_not_moved(self):
        plan = json.loads(run("plan", "builtin:sphere", "--json").stdout)
        skipped = {entry["name"]: entry["reason"] for entry in plan["skipped"]}
        self.assertIn("keyframes", skipped["body_motion"])
        self.assertIn("pins.motion", skipped["pin_motion"])


class Crossed(unittest.TestCase):
    def test_check_names_the_triangles_that_cross_and_draws_them(self):
        with tempfile.TemporaryDirectory() as folder:
            scene, picture = os.path.join(folder, "crossed.toml"), os.path.join(folder, "crossed.png")
            with open(scene, "w") as file:
                file.write(CROSSED)
            found = json.loads(run("check", scene, "--json", "--picture", picture).stdout)
            self.assertGreater(os.path.getsize(picture), 1000)
            self.assertFalse(found["clean"])
            kinds = {finding["kind"]: finding for finding in found["findings"]}
            for kind in ["self_intersection", "body_intersection"]:
                self.assertTrue(kinds[kind]["pairs"])
                self.assertTrue(set(pair[0] for pair in kinds[kind]["pairs"]) <= set(kinds[kind]["triangles"]))
            # The sheets' triangles are numbered one after the other: 32 each.
            self.assertTrue(all(a < 32 <= b for a, b in kinds["self_intersection"]["pairs"]))
            self.assertIn("pole", kinds["body_intersection"]["text"])


if __name__ == "__main__":
    unittest.main(verbosity=2)
