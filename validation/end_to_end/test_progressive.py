"""solver.progressive: a sheet that is draped from coarse to fine ends where the fine sheet would have come to rest."""
import json
import os
import subprocess
import tempfile
import unittest

import h5py
import numpy as np

PROGRAM = os.environ.get("SELVAGE", "build/selvage")
# Folds that touch each other have more than one shape at rest: what is compared here is the way to one that has not.
HANGING = ["builtin:hanging", "--set", "sheet.resolution=49", "--set", "output.picture=false", "--set",
           "output.precision=lossless", "--set", "contact.self=false", "--set",
           "solver.integrator=implicit_euler", "--set", "solver.tolerance=1e-4", "--quiet"]
CLOSE = 1e-4   # [m], a fifth of what one halving of the edge length moves


def drape(folder, *options):
    return subprocess.run([PROGRAM, "drape", *HANGING, "-o", folder, *options],
                          capture_output=True, text=True, timeout=200)


def summary(folder):
    with open(os.path.join(folder, "summary.json")) as file:
        return json.load(file)


def rest(folder):
    with h5py.File(os.path.join(folder, "run.h5"), "r") as file:
        return file["selvage/positions"][-1].astype(float)


class Progressive(unittest.TestCase):
    def test_the_result_is_that_of_the_direct_run_for_fewer_iterations_on_the_fine_sheet(self):
        with tempfile.TemporaryDirectory() as root:
            coarse_first, direct = (os.path.join(root, name) for name in ["coarse_first", "direct"])
            self.assertEqual(drape(coarse_first).returncode, 0)
            self.assertEqual(drape(direct, "--set", "solver.progressive=false").returncode, 0)
            first, other = summary(coarse_first), summary(direct)
            # The sheet rests as well behind the plane of its pins as before it.
            mirrored = rest(direct) * [1, -1, 1] + [0, 1, 0]
            apart = [np.linalg.norm(rest(coarse_first) - other, axis=1).max() for other in (rest(direct), mirrored)]
            self.assertLess(min(apart), CLOSE)
            for energy in ["membrane_J", "gravity_J"]:
                self.assertAlmostEqual(first["energy"][energy], other["energy"][energy], delta=1e-4)
            stages = first["coarse_start"]
            self.assertEqual([stage["vertices"] for stage in stages], [169, 625])
            on_fine = first["newton_iterations"] - sum(stage["newton_iterations"] for stage in stages)
            self.assertLess(2.5 * on_fine, other["newton_iterations"])
            self.assertIn("coarse_start", first["active"])
            self.assertEqual(other["coarse_start"], [])
            self.assertIn({"name": "coarse_start", "reason": "solver.progressive is false"}, other["skipped"])

    def test_a_run_stopped_on_a_coarse_sheet_goes_on_to_the_same_end(self):
        with tempfile.TemporaryDirectory() as root:
            whole, stopped = (os.path.join(root, name) for name in ["whole", "stopped"])
            self.assertEqual(drape(whole).returncode, 0)
            result = drape(stopped, "--set", "solver.max_wall=0.02")
            self.assertEqual(result.returncode, 4, result.stderr)
            self.assertEqual(summary(stopped)["coarse_start"], [])
            self.assertEqual(drape(stopped, "--resume").returncode, 0)
            np.testing.assert_array_equal(rest(whole), rest(stopped))

    def test_what_cannot_start_coarse_says_why(self):
        reasons = {"builtin:sphere": "solver.until", "builtin:tshirt": "garment", "builtin:cusick": "bodies"}
        for scene, word in reasons.items():
            with self.subTest(scene):
                plan = subprocess.run([PROGRAM, "plan", scene, "--json"], capture_output=True, text=True, timeout=60)
                reasons = {part["name"]: part["reason"] for part in json.loads(plan.stdout)["skipped"]}
                self.assertIn(word, reasons["coarse_start"])

    def test_a_garment_of_a_fine_mesh_is_sewn_on_a_coarse_one(self):
        with tempfile.TemporaryDirectory() as folder:
            result = subprocess.run([PROGRAM, "drape", "builtin:vest", "-o", folder, "--quiet", "--set",
                                     "garment.resolution=0.0062", "--set", "output.picture=false"],
                                    capture_output=True, text=True, timeout=300)
            self.assertEqual(result.returncode, 0, result.stderr)
            own = summary(folder)
            self.assertEqual([stage["used"] for stage in own["coarse_start"]], [True, True])
            self.assertNotIn("sew", own["phases"])
            self.assertFalse(os.path.exists(os.path.join(folder, "sewing.h5")))
            self.assertEqual((own["self"]["intersections"], own["body"]["intersections"]), (0, 0))
            with h5py.File(os.path.join(folder, "run.h5"), "r") as file:
                self.assertGreaterEqual(len(file["selvage/time"]), 2)


if __name__ == "__main__":
    unittest.main()
