"""Panels that a pattern gives no place are placed on the body by their names and seams."""
import json
import subprocess
import unittest

from scratch import PROGRAM, Drapes

SCENE = '[garment]\npattern = "flat.json"\nresolution = 0.03\n%s[[body]]\nname = "person"\nshape = "mannequin"\n'


class Arrange(Drapes):
    def flat_style(self, style, rename=lambda name: name):
        """Writes a style's pattern without places, its panels under other names."""
        made = subprocess.run([PROGRAM, "styles", style, "--body", "builtin:mannequin", "-o", self.path("style.json")],
                              capture_output=True, text=True, timeout=60)
        self.assertEqual(made.returncode, 0, made.stderr)
        with open(self.path("style.json")) as file:
            pattern = json.load(file)
        panels = pattern["pattern"]["panels"]
        for panel in panels.values():
            for key in ("translation", "rotation", "wrap"):
                panel.pop(key, None)
            panel.update(translation=[0, 0, 0], rotation=[0, 0, 0])
        pattern["pattern"]["panels"] = {rename(name): panel for name, panel in panels.items()}
        pattern["pattern"].pop("panel_order", None)
        for stitch in pattern["pattern"]["stitches"]:
            for side in stitch:
                if isinstance(side, dict):
                    side["panel"] = rename(side["panel"])
        self.write("flat.json", json.dumps(pattern))

    def check(self, more="", scene=SCENE):
        result = subprocess.run([PROGRAM, "check", self.write("scene.toml", scene % more)], capture_output=True,
                                text=True, timeout=60)
        return result.returncode, result.stdout + result.stderr

    def test_a_flat_vest_is_placed_and_draped(self):
        self.flat_style("vest")
        code, said = self.check()
        self.assertEqual(code, 0, said)
        self.assertIn("the 2 panels are placed on the body by their names and seams", said)
        self.assertNotIn("warning", said)
        _, positions, summary = self.drape_frames("vest", self.path("scene.toml"))
        self.assertEqual(summary["status"], "converged")
        self.assertEqual((summary["self"]["intersections"], summary["body"]["intersections"]), (0, 0))
        self.assertLess(summary["seams"]["max_gap_m"], 1e-3)
        self.assertGreater(positions[-1][:, 2].max(), 1.3)   # it hangs from the shoulders

    def test_names_are_read_in_any_order_and_spelling(self):
        names = {"front": "VestFront", "back": "b_top"}
        self.flat_style("vest", names.get)
        code, said = self.check()
        self.assertEqual(code, 0, said)
        self.assertNotIn("warning", said)

    def test_sleeves_are_rolled_around_the_arms(self):
        self.flat_style("tshirt")
        code, said = self.check()
        self.assertEqual(code, 0, said)
        self.assertIn("panels are placed on the body", said)
        self.assertNotIn("penetration", said)

    def test_panels_whose_names_tell_nothing_are_named_in_the_scene(self):
        self.flat_style("vest", {"front": "A17", "back": "A18"}.get)
        code, said = self.check()
        self.assertEqual(code, 2, said)
        self.assertIn("pattern.panels.A17", said)
        self.assertIn("[garment.parts]", said)
        parts = '[garment.parts]\nA17 = "front torso"\nA18 = "back torso"\n'
        code, said = self.check(parts)
        self.assertEqual(code, 0, said)
        self.assertNotIn("warning", said)
        code, said = self.check(parts + 'A19 = "hood"\n')
        self.assertEqual(code, 2, said)
        self.assertIn("garment.parts.A19", said)

    def test_panels_without_a_place_on_a_body_that_is_no_person_stay_and_are_told(self):
        self.flat_style("vest")
        corners, faces = ["v 0 0 0", "v 1 0 0", "v 0 1 0", "v 0 0 1"], ["f 1 3 2", "f 1 2 4", "f 1 4 3", "f 2 3 4"]
        self.write("block.obj", corners + faces)
        on_block = SCENE.replace('shape = "mannequin"', 'mesh = "block.obj"')
        _, said = self.check(scene=on_block)
        self.assertIn("warning: no_place: the 2 panels all have the same place", said)
        code, said = self.check('arrange = "always"\n', scene=on_block)
        self.assertEqual(code, 2, said)
        self.assertRegex(said, r"^selvage: .*body\[0\]: .*expected a body that stands upright")

    def test_panels_stay_where_a_scene_wants_them_to(self):
        self.flat_style("vest")
        code, said = self.check('arrange = "never"\n')
        self.assertIn("intersect at the start", said)


if __name__ == "__main__":
    unittest.main()
