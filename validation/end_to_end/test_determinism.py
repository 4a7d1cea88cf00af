"""The same input gives the same motion bit by bit, whatever the number of threads."""
import os
import subprocess
import tempfile
import unittest

import h5py
import numpy as np

PROGRAM = os.environ.get("SELVAGE", "build/selvage")
SCENES = {
    # Large enough to be cut into several tasks, which threads share.
    "hanging": ["builtin:hanging", "--set", "sheet.resolution=65", "--set", "solver.until=0.4"],
    "sphere": ["builtin:sphere", "--set", "sheet.resolution=21", "--set", "solver.until=0.6"],
    "tshirt": ["builtin:tshirt", "--set", "garment.resolution=0.04"],
}
FAR = 1e-4   # [m]


class Determinism(unittest.TestCase):
    def drape(self, folder, scene, threads):
        result = subprocess.run([PROGRAM, "drape", *scene, "-o", folder, "--quiet", "--threads", str(threads),
                                 "--set", "output.picture=false", "--set", "output.precision=lossless"],
                                capture_output=True, text=True, timeout=120)
        self.assertEqual(result.returncode, 0, result.stderr)

    def positions(self, folder, name="run.h5"):
        path = os.path.join(folder, name)
        if not os.path.exists(path):
            return None
        with h5py.File(path, "r") as file:
            return file["selvage/positions"][()]

    def check(self, name):
        with tempfile.TemporaryDirectory() as root:
            folders = [os.path.join(root, run) for run in ["two", "two_again", "one"]]
            for folder, threads in zip(folders, [2, 2, 1]):
                self.drape(folder, SCENES[name], threads)
            for file in ["sewing.h5", "run.h5"]:
                first, again, one = (self.positions(folder, file) for folder in folders)
                np.testing.assert_array_equal(first, again, file)
                np.testing.assert_array_equal(first, one, file)
            two = self.positions(folders[0])
            self.assertGreater(np.abs(two[-1] - two[0]).max(), FAR, "nothing moved, so nothing was compared")

    def test_a_hanging_sheet(self):
        self.check("hanging")

    def test_a_sheet_on_a_sphere(self):
        self.check("sphere")

    def test_a_garment(self):
        self.check("tshirt")


if __name__ == "__main__":
    unittest.main()
