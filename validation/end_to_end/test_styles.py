"""`selvage styles`: the catalogue, and patterns that are drafted for a body."""
import json
import os
import subprocess
import tempfile
import unittest

PROGRAM = os.environ["SELVAGE"]
NAMED = {"vest", "tshirt", "shirt", "dress", "gathered_skirt", "circle_skirt", "trousers", "hoody"}


def run(*arguments):
    return subprocess.run([PROGRAM, *arguments], capture_output=True, text=True, timeout=120)


class Styles(unittest.TestCase):
    def test_every_style_is_listed_and_is_a_built_in_scene(self):
        styles = {style["name"] for style in json.loads(run("styles", "--json").stdout)}
        self.assertLessEqual(NAMED, styles)
        scenes = {scene["name"] for scene in json.loads(run("scenes", "--json").stdout)}
        self.assertLessEqual(styles, scenes)

    def test_a_written_pattern_starts_as_the_built_in_one_does(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "skirt.json")
            result = run("styles", "circle_skirt", "--set", "body[0].size=L", "-o", path)
            self.assertEqual(result.returncode, 0, result.stderr)
            with open(path) as file:
                pattern = json.load(file)
            self.assertEqual(pattern["properties"]["units_in_meter"], 100)
            self.assertEqual(set(pattern["pattern"]["panel_order"]), set(pattern["pattern"]["panels"]))
            scene = os.path.join(folder, "scene.toml")
            with open(scene, "w") as file:
                file.write('[garment]\npattern = "skirt.json"\nrotation_order = "xyz"\nresolution = 0.04\n'
                           '[[body]]\nname = "mannequin"\nshape = "mannequin"\nsize = "L"\n')
            checked = run("check", scene)
            self.assertEqual(checked.returncode, 0, checked.stdout + checked.stderr)
            built_in = run("check", "builtin:circle_skirt", "--set", "garment.size=L",
                           "--set", "garment.resolution=0.04")
            self.assertEqual(built_in.returncode, 0, built_in.stdout + built_in.stderr)
            self.assertEqual(checked.stdout.split(":")[1], built_in.stdout.split(":")[1])

    def test_unknown_styles_and_bodies_are_refused(self):
        for arguments, word in [(["styles", "tshrt"], "tshirt"),
                                (["styles", "vest", "--body", "none.obj"], "none.obj")]:
            result = run(*arguments)
            self.assertEqual(result.returncode, 2, result.stderr)
            self.assertIn(word, result.stderr)


if __name__ == "__main__":
    unittest.main()
