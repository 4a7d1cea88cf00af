"""How contact is met depends on what is there: what is special in one place changes nothing elsewhere."""
import unittest

import numpy as np

from scratch import Drapes

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


class LocalContact(Drapes):
    def drape(self, name, scene, *more):
        """Returns the last positions [m] and the summary."""
        _, positions, summary = self.drape_frames(name, scene, *more)
        return positions[-1], summary

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

    def test_a_body_that_moves_far_away_changes_neither_how_cloth_rests_nor_the_work(self):
        far = ["[[body]]", 'name = "far"', 'shape = "sphere"', "radius = 0.1", "center = [0, 30, 5]",
               "[[body.keyframe]]", "time = 0.1", "translation = [0, 1, 0]"]
        ball = ["[[body]]", 'shape = "sphere"', "radius = 0.08"]
        for name, body, most, close in (("floor", FLOOR, 12, 2e-6), ("ball", ball, 40, 1e-3)):
            with self.subTest(name):
                sheet = ["[[sheet]]", "width = 0.2", "height = 0.2", "resolution = 9", 'fabric = "cotton"',
                         "center = [0, 0, {}]".format(0.004 if name == "floor" else 0.084)]
                rest = ["[solver]", 'until = "equilibrium"']
                alone, first = self.drape(name + "_alone", sheet + body + rest)
                x, second = self.drape(name + "_with", sheet + body + far + rest)
                print(name, first["steps"], "steps alone,", second["steps"], "with a body far away; heights",
                      alone[:, 2].min(), x[:, 2].min())
                self.assertAlmostEqual(x[:, 2].min(), alone[:, 2].min(), delta=close)
                self.assertLessEqual(second["steps"], most)
                # Which others follow hangs on whether the first attempt at a static solution is made in time.
                self.assertEqual(second["integrators"][0], first["integrators"][0])

    def test_a_heavy_sheet_changes_nothing_of_a_light_one_beside_it(self):
        light = ["[[sheet]]", "width = 0.2", "height = 0.2", "resolution = 9", 'fabric = "silk"',
                 "center = [0, 0, 0.004]"]
        heavy = ["[[sheet]]", "width = 0.2", "height = 0.2", "resolution = 9", 'fabric = "leather"',
                 "center = [0.5, 0, 0.004]"]
        rest = ["[solver]", 'until = "equilibrium"']
        alone, _ = self.drape("alone", light + FLOOR + rest)
        beside, _ = self.drape("beside", light + heavy + FLOOR + rest)
        heights = alone[:, 2].mean(), beside[:81, 2].mean(), beside[81:, 2].mean()
        print("silk rests at", heights[0], "and beside leather at", heights[1], "which rests at", heights[2])
        self.assertAlmostEqual(heights[1], heights[0], delta=2e-6)
        self.assertAlmostEqual(heights[2], heights[0], delta=2e-5)

    # Contact of a rim as steep as its neighbours' distance pushed them 2 to 5 mm aside by then.
    def test_aligned_cards_without_friction_stay_above_each_other(self):
        cards = []
        for k in (1, 2, 3):
            cards += ["[[sheet]]", "width = 0.063", "height = 0.088", "resolution = 9",
                      f"center = [0, 0, {0.0025 * k}]", 'fabric = "card"']
        x, _ = self.drape("cards", cards + FLOOR + [
            "friction = 0", "[fabric.card]", "areal_density = 0.3", "thickness = 0.0003", "stretch_weft = 1e5",
            "stretch_warp = 1e5", "shear = 4e4", "bending_weft = 1e-3", "bending_warp = 1e-3", "friction = 0",
            "damping = 0.5", "[solver]", "until = 0.5"])
        for card in np.split(x, 3):
            aside = np.linalg.norm(card[:, :2].mean(axis=0))
            way = card[-1, :2] - card[0, :2]
            turned = np.degrees(np.arctan2(way[1], way[0]) - np.arctan2(0.088, 0.063))
            print(f"card: {1000 * aside:.4f} mm aside, turned by {turned:.4f} degrees")
            self.assertLess(aside, 1e-3)
            self.assertLess(abs(turned), 1)


if __name__ == "__main__":
    unittest.main()
