"""How contact is met depends on what is there: what is special in one place changes nothing elsewhere."""
import json
import os
import subprocess
import unittest

import h5py
import numpy as np

from scratch import Scratch

PROGRAM = os.environ.get("SELVAGE", "build/selvage")
PLAIN = ["--quiet", "--threads", "2", "--set", "output.picture=false", "--set", "output.precision=lossless"]
FLOOR = ["[[body]]", 'name = "floor"', 'shape = "plane"']


def sheet_mesh(cells, spacing, sliver):
    """Lines of an OBJ file of a square sheet; a sliver narrower by a factor of 350 lies beside one of its diagonals."""
    side = cells + 1
    lines = [f"v {(c - cells / 2) * spacing} {(r - cells / 2) * spacing} 0" for r in range(side) for c in range(side)]
    faces = []
    for r in range(cells):
        for c in range(cells):
            v = r * side + c + 1
            faces += [(v, v + 1, v + side + 1), (v, v + side + 1, v + side)]
    if sliver:
        middle = cells // 2
        a, b, c = faces.pop(2 * (middle * cells + middle))
        beside = np.array([0.5, 0.5]) + 0.002 * np.array([1, -1])
        x, y = (np.array([middle, middle]) + beside - cells / 2) * spacing
        lines.append(f"v {x} {y} 0")
        new = side * side + 1
        faces += [(a, b, new), (b, c, new), (a, new, c)]
    return lines + ["f {} {} {}".format(*f) for f in faces]


class LocalContact(Scratch):
    def drape(self, name, scene, *more, code=0, seconds=120):
        """Runs a scene, lines or a file; returns the last positions [m] and the summary."""
        file = scene if isinstance(scene, str) else self.write(name + ".toml", scene)
        result = subprocess.run([PROGRAM, "drape", file, "-o", self.path(name), *PLAIN, *more],
                                capture_output=True, text=True, timeout=seconds)
        self.assertEqual(result.returncode, code, result.stderr)
        with h5py.File(os.path.join(self.path(name), "run.h5"), "r") as run:
            positions = run["selvage/positions"][-1].astype(float)
        with open(os.path.join(self.path(name), "summary.json")) as summary:
            return positions, json.load(summary)

    def test_layers_rest_as_far_apart_with_a_sliver_as_without_it(self):
        heights = {}
        for name, sliver in (("plain", False), ("sliver", True)):
            self.write(f"{name}.obj", sheet_mesh(8, 0.0375, sliver))
            x, _ = self.drape(name, [
                "[[sheet]]", 'shape = "mesh"', f'mesh = "{name}.obj"', 'fabric = "denim"', "center = [0, 0, 0.003]",
                "[[sheet]]", "width = 0.2", "height = 0.2", "resolution = 11", 'fabric = "denim"',
                "center = [0, 0, 0.007]", *FLOOR, "[solver]", 'until = "equilibrium"'])
            lower = 81 + sliver
            heights[name] = x[lower:, 2].mean() - x[:lower, 2].mean()
        print("layers are apart", heights)
        self.assertGreater(heights["plain"], 0.0015)
        self.assertAlmostEqual(heights["sliver"], heights["plain"], delta=2e-5)


if __name__ == "__main__":
    unittest.main()
