"""Motions at the default settings: stiff cloth swings, falls, folds and comes to rest as it should, whole runs."""
import math
import unittest

import numpy as np

from scratch import Drapes

FLOOR = ["[[body]]", 'name = "floor"', 'shape = "plane"']


def fabric(stretch, bending, density, friction=0.0):
    return ["[fabric.f]", f"areal_density = {density}", "thickness = 0.0003", f"stretch_weft = {stretch}",
            f"stretch_warp = {stretch}", f"shear = {0.4 * stretch}", f"bending_weft = {bending}",
            f"bending_warp = {bending}", f"friction = {friction}", "damping = 0"]


class Motion(Drapes):
    def first_time(self, times, values, limit):
        """When values first fall to the limit, evenly between frames."""
        k = int(np.argmax(values <= limit))
        self.assertGreater(k, 0, f"{values} do not fall to {limit}")
        part = (values[k - 1] - limit) / (values[k - 1] - values[k])
        return times[k - 1] + part * (times[k] - times[k - 1])

    # Accepted before they were solved, steps of 20 ms never let the stiff ones hang.
    def test_stiff_sheets_swing_like_rigid_plates(self):
        side, cells = 0.2, 8
        # A rigid sheet of lumped masses: trapezoidal weights along its length.
        weight = np.full(cells + 1, 1.0)
        weight[[0, -1]] = 0.5
        arm = np.linspace(0, side, cells + 1)
        length = (weight @ arm**2) / (weight @ arm)
        rigid = 1.854074677 * math.sqrt(length / 9.81)  # K(1 / sqrt 2)
        for stretch in (1e3, 1e5, 1e7):
            times, x, summary = self.drape_frames(f"pendulum{stretch:g}", [
                "[[sheet]]", f"width = {side}", f"height = {side}", f"resolution = {cells + 1}",
                "center = [0.1, 0, 1]", 'fabric = "f"', "[pins]", 'sheet = "left_edge"', "[solver]", "until = 0.3",
                "frame_rate = 50", *fabric(stretch, 0.005, 0.3)])
            hangs = self.first_time(times, x[:, :, 0].mean(axis=1), 0.0)
            print(f"pendulum of {stretch:g} N/m hangs after {hangs:.4f} s, a rigid one after {rigid:.4f} s")
            self.assertLess(abs(hangs / rigid - 1), 0.025)
            self.assertEqual(summary["accuracy"]["unsolved"], 0)

    def test_a_leaning_card_falls_over_as_a_rod_without_friction_does(self):
        times, x, _ = self.drape_frames("card", [
            "[[sheet]]", "width = 0.063", "height = 0.088", "resolution = 9", "rotation = [0, -65, 0]",
            "center = [0, 0, 0.0304]", 'fabric = "f"', *FLOOR, "friction = 0", "[solver]", "until = 0.1",
            "frame_rate = 200", "step = 0.005", *fabric(1e5, 0.005, 0.3)])
        height = x[:, :, 2].max(axis=1)
        # The time of a rod, from its energy (docs: validate motion). Lumped masses of 9 vertices a side fall a little
        # later.
        self.assertLess(abs(self.first_time(times, height, 0.5 * height[0]) / 0.0762 - 1), 0.04)
        self.assertLess(abs(x[-1, :, 1].mean() - x[0, :, 1].mean()), 5e-4)

    def test_a_sheet_that_falls_freely_keeps_its_way_in_every_implicit_integrator(self):
        for integrator in ("implicit_euler", "bdf2", "implicit_midpoint"):
            times, x, _ = self.drape_frames("fall", [
                "[[sheet]]", "width = 4", "height = 4", "resolution = 17", 'mesh_family = "irregular"',
                "rotation = [30, 20, 10]", "center = [3, 5, 50]", 'fabric = "f"', "[solver]",
                f'integrator = "{integrator}"', "until = 1", "frame_rate = 50", *fabric(1e6, 1e-5, 0.005)])
            way = x[-1].mean(axis=0) - x[0].mean(axis=0)
            # Implicit Euler falls g t (t + h) / 2.
            expected = 0.5 * 9.81 * (1 + 0.02 * (integrator == "implicit_euler"))
            self.assertLess(abs(-way[2] / expected - 1), 1e-3, integrator)
            self.assertLess(np.hypot(way[0], way[1]), 1e-3, integrator)

    def test_strips_of_any_stiffness_come_to_rest_by_default(self):
        tips = []
        for stretch in (1e3, 1e5, 1e6):
            _, x, summary = self.drape_frames(f"strip{stretch:g}", [
                "[[sheet]]", "width = 0.2", "height = 0.025", "resolution = 41", 'mesh_family = "irregular"',
                "center = [0, 0, 1]", 'fabric = "f"', "[pins]", 'sheet = "two_rows"', "[solver]",
                'until = "equilibrium"', *fabric(stretch, 1e-4, 0.2, 0.3)])
            self.assertEqual(summary["status"], "converged")
            tips.append(x[-1, :, 2].min() - 1)
        print("tips of strips hang at", tips)
        # The elastica of this weight and rigidity hangs 0.947 of its free length down.
        for tip in tips:
            self.assertLess(abs(tip / (-0.947 * 0.195) - 1), 0.02)

    def test_paper_is_folded_by_its_corners_without_stretch(self):
        _, _, summary = self.drape_frames("paper", [
            "[[sheet]]", "width = 0.21", "height = 0.297", "resolution = 15", 'fabric = "f"', "center = [0, 0, 0.004]",
            *FLOOR, "[[pins.motion]]", 'group = "right_corners"', "start = 0", "end = 1", "turns = -0.5",
            "axis = [0, 1, 0]", "point = [0, 0, 0.0055]", "[[pins.motion]]", 'group = "corners"', "start = 1.05",
            "end = 1.06", "[solver]", "until = 1.2", *fabric(3e5, 3e-4, 0.08, 0.3)])
        stretch = summary["stretch"]
        print("paper is stretched by", stretch["largest"], "at most")
        self.assertLess(stretch["largest"], 1e-3)


if __name__ == "__main__":
    unittest.main()
