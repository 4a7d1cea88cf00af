"""Wind and still air as a user meets them: terminal velocity, gusts that repeat, and the flag."""
import json
import math
import os
import pathlib
import subprocess
import tempfile
import unittest

import h5py
import numpy as np

PROGRAM = os.path.abspath(os.environ.get("SELVAGE", "build/selvage"))
FALL = """[[sheet]]
width = 0.2
height = 0.2
resolution = 5
fabric = "own"
[fabric.own]
base = "cotton"
areal_density = 0.1
damping = 0
[wind]
still_air = true
density = 1.25
normal_coefficient = 1.6
[solver]
until = 1.5
integrator = "%s"
[output]
picture = false
precision = "lossless"
"""
FLAG = ["builtin:flag", "--set", "sheet.resolution=13", "--set", "solver.until=0.6", "--set", "output.picture=false"]


class Wind(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.root = pathlib.Path(self.folder.name)

    def drape(self, name, *arguments):
        result = subprocess.run([PROGRAM, "drape", *arguments, "-o", name, "--quiet"], cwd=self.root,
                                capture_output=True, text=True, timeout=100)
        self.assertEqual(result.returncode, 0, result.stderr)
        with h5py.File(self.root / name / "run.h5", "r") as file:
            return file["selvage/positions"][()].astype(float), file["selvage/time"][()]

    def test_a_falling_sheet_reaches_its_terminal_velocity(self):
        for integrator in ["bdf2", "velocity_verlet"]:
            (self.root / "fall.toml").write_text(FALL % integrator)
            positions, time = self.drape(integrator, "fall.toml")
            height = positions[:, :, 2].mean(axis=1)
            velocity = (height[-2] - height[-1]) / (time[-1] - time[-2])
            self.assertAlmostEqual(velocity, math.sqrt(2 * 0.1 * 9.81 / (1.25 * 1.6)), delta=2e-3)
            summary = json.loads((self.root / integrator / "summary.json").read_text())
            self.assertIn("air_drag", summary["active"])
            self.assertIn("wind", [part["name"] for part in summary["skipped"]])

    def test_gusts_repeat_with_their_seed_on_any_number_of_threads(self):
        first, _ = self.drape("first", *FLAG)
        again, _ = self.drape("again", *FLAG, "--threads", "1")
        other, _ = self.drape("other", *FLAG, "--set", "wind.seed=2")
        np.testing.assert_array_equal(first, again)
        self.assertGreater(np.abs(first - other).max(), 0.01)

    def test_the_flag_flies_downwind_and_stays_at_its_pole(self):
        positions, _ = self.drape("flag", *FLAG)
        held = np.flatnonzero(positions[0, :, 0] < 1e-6)
        self.assertEqual(np.abs(positions[:, held] - positions[0, held]).max(), 0)
        self.assertGreater(positions[-1, :, 0].mean(), 0.3)
        self.assertGreater(np.abs(positions[:, :, 1]).max(), 0.05)


if __name__ == "__main__":
    unittest.main()
