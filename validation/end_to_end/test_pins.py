"""Pins act on the sheet or panel that they name, and held vertices that meet are told of."""
import json
import os
import pathlib
import subprocess
import tempfile
import unittest

import h5py
import numpy as np

PROGRAM = os.environ.get("SELVAGE", "build/selvage")
END = "[solver]\nuntil = 0.3\n[output]\npicture = false\nprecision = \"lossless\"\n"
SHEETS = """[[sheet]]
resolution = 5
width = 0.2
height = 0.2
center = [0, 0, 1]
[[sheet]]
name = "upper"
resolution = 6
width = 0.2
height = 0.2
center = [0, 0, 1.5]
"""
PATTERN = {"pattern": {"panels": {"flag": {"translation": [0, 0, 0], "rotation": [0, 0, 0],
                                           "vertices": [[0, 0], [20, 0], [20, 20], [0, 20]],
                                           "edges": [{"endpoints": [k, (k + 1) % 4]} for k in range(4)]}},
                       "stitches": []},
           "properties": {"units_in_meter": 100}}


class Pins(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.root = pathlib.Path(self.folder.name)
        (self.root / "flag.json").write_text(json.dumps(PATTERN))

    def selvage(self, command, text, *arguments):
        (self.root / "scene.toml").write_text(text)
        return subprocess.run([os.path.abspath(PROGRAM), command, "scene.toml", *arguments], cwd=self.root,
                              capture_output=True, text=True, timeout=100)

    def drape(self, text):
        """Returns how far each vertex has moved, and the panel of each."""
        result = self.selvage("drape", text + END, "-o", "out", "--quiet")
        self.assertEqual(result.returncode, 0, result.stderr)
        with h5py.File(self.root / "out/run.h5", "r") as file:
            x = file["selvage/positions"][()]
            panel = file["VTKHDF/PointData/panel"][: x.shape[1]]
        return np.linalg.norm(x[-1] - x[0], axis=1), panel

    def test_one_sheet_of_two_is_held(self):
        moved, panel = self.drape(SHEETS + '[[pins.hold]]\npanel = "upper"\ngroup = "corners"\nvertices = "2"\n')
        held = np.flatnonzero(moved == 0)
        np.testing.assert_array_equal(held - 25, [0, 2, 5, 30, 35])
        self.assertGreater(moved[panel == 0].min(), 0.15)

    def test_a_panel_of_a_garment_is_held(self):
        garment = '[garment]\npattern = "flag.json"\nresolution = 0.05\n'
        moved, _ = self.drape(garment + '[[pins.hold]]\npanel = "flag"\ngroup = "top_edge"\n')
        self.assertGreaterEqual((moved == 0).sum(), 4)
        self.assertGreater(moved.max(), 0)
        self.assertLess(moved.max(), 0.1)

    def test_the_panel_that_moves_is_the_named_one(self):
        motion = '[[pins.motion]]\npanel = "sheet[0]"\nvertices = "12"\nvelocity = [0, 0, -1]\n'
        moved, panel = self.drape(SHEETS + motion)
        self.assertAlmostEqual(moved[12], 0.3, places=4)
        self.assertGreater(moved[panel == 1].min(), 0.15)

    def test_held_vertices_that_are_driven_together_are_told_of(self):
        scene = ('[[sheet]]\nwidth = 0.4\nheight = 0.4\nresolution = 13\n'
                 '[[pins.motion]]\ngroup = "left_edge"\nvelocity = [0.6, 0, 0]\nend = %s\n'
                 '[[pins.motion]]\ngroup = "right_edge"\nvelocity = [-0.6, 0, 0]\nend = %s\n')
        meets = self.selvage("check", scene % (1, 1))
        self.assertRegex(meets.stdout, r"held vertices \d+ of sheet\[0\] and \d+ of sheet\[0\] are driven against")
        self.assertRegex(meets.stdout, r"[01]\.\d mm apart at 0\.33")
        apart = self.selvage("check", scene % (0.2, 0.2))
        self.assertNotIn("driven against", apart.stdout)

    def test_a_meeting_within_whole_turns_is_told_of(self):
        scene = ('[[sheet]]\nwidth = 0.4\nheight = 0.4\nresolution = 9\n[pins]\nsheet = "right_edge"\n'
                 '[[pins.motion]]\ngroup = "left_edge"\naxis = [0, 0, 1]\npoint = [%g, 0, 0]\nturns = 4\n')
        self.assertRegex(self.selvage("check", scene % 0).stdout, r"driven against each other: .* mm apart at 0\.06")
        self.assertNotIn("driven against", self.selvage("check", scene % -0.2).stdout)

    def test_edges_that_cross_between_their_ends_are_told_of(self):
        sheets = ('[[sheet]]\nwidth = 0.4\nheight = 0.4\nresolution = 3\ncenter = [0, 0, 0.5]\n'
                  '[[sheet]]\nname = "upper"\nwidth = 0.4\nheight = 0.4\nresolution = 3\n'
                  'center = [-0.1, %g, 1]\n[[pins.hold]]\npanel = "sheet[0]"\ngroup = "left_edge"\n'
                  '[[pins.motion]]\npanel = "upper"\ngroup = "top_edge"\nvelocity = [0, 0, -1]\n')
        self.assertRegex(self.selvage("check", sheets % -0.1).stdout, r"driven against each other: .* mm apart at 0\.5")
        self.assertNotIn("driven against", self.selvage("check", sheets % 0.1).stdout)

    def test_held_vertices_that_come_near_with_room_for_the_cloth_are_not_told_of(self):
        check = subprocess.run([PROGRAM, "check", "builtin:stress_fold"], capture_output=True, text=True)
        self.assertEqual(check.returncode, 0, check.stdout)


if __name__ == "__main__":
    unittest.main()
