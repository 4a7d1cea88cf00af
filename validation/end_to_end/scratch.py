"""What tests share that write files of their own, and that drape the scenes they have written."""
import json
import os
import subprocess
import tempfile
import unittest

import h5py

PROGRAM = os.environ.get("SELVAGE", "build/selvage")


class Scratch(unittest.TestCase):
    """`folder` is there for one test, and removed with what lies in it."""

    def setUp(self):
        holder = tempfile.TemporaryDirectory()
        self.addCleanup(holder.cleanup)
        self.folder = holder.name

    def path(self, name):
        return os.path.join(self.folder, name)

    def write(self, name, text):
        """Writes a text, or lines; returns the path."""
        os.makedirs(os.path.dirname(self.path(name)), exist_ok=True)
        with open(self.path(name), "w") as file:
            file.write(text if isinstance(text, str) else "\n".join(text) + "\n")
        return self.path(name)


class Drapes(Scratch):
    def drape_frames(self, name, scene, *more, code=0, seconds=120):
        """Runs a scene, lines or a file, without a picture; returns times [s], positions [m] of all frames, summary."""
        file = scene if isinstance(scene, str) else self.write(name + ".toml", scene)
        result = subprocess.run([PROGRAM, "drape", file, "-o", self.path(name), "--quiet", "--threads", "2", "--set",
                                 "output.picture=false", "--set", "output.precision=lossless", *more],
                                capture_output=True, text=True, timeout=seconds)
        self.assertEqual(result.returncode, code, result.stderr)
        with h5py.File(os.path.join(self.path(name), "run.h5"), "r") as run:
            times, positions = run["VTKHDF/Steps/Values"][:], run["selvage/positions"][:].astype(float)
        with open(os.path.join(self.path(name), "summary.json")) as summary:
            return times, positions, json.load(summary)
