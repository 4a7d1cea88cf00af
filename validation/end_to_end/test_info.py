"""`info` tells what each kind of file holds, and names cannot break the files that they are written to."""
import json
import os
import subprocess
import tempfile
import unittest

PROGRAM = os.environ.get("SELVAGE", "build/selvage")
SQUARE = "o square\nv 0 0 0\nv 2 0 0\nv 2 1 0\nv 0 1 0\nf 1 2 3\nf 1 3 4\n"
PATTERN = {"pattern": {"panels": {"front": {
    "translation": [0, 0, 0], "rotation": [0, 0, 0], "vertices": [[0, 0], [30, 0], [30, 20], [0, 20]],
    "edges": [{"endpoints": [k, (k + 1) % 4]} for k in range(4)]}}, "stitches": []},
    "properties": {"units_in_meter": 100}}
SCENE = '[[sheet]]\nresolution = 5\nfabric = "linen"\n[[body]]\nshape = "sphere"\n'
FABRICS = '[fabric.thin]\nbase = "silk"\nareal_density = 0.05\n'


def call(*arguments):
    return subprocess.run([PROGRAM, *arguments], capture_output=True, text=True, timeout=60)


class Info(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        holder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(holder.cleanup)
        cls.folder = holder.name

    def write(self, name, text):
        path = os.path.join(self.folder, name)
        with open(path, "w") as file:
            file.write(text)
        return path

    def told(self, source):
        result = call("info", source, "--json")
        self.assertEqual(result.returncode, 0, result.stderr)
        plain = call("info", source)
        self.assertEqual(plain.returncode, 0, plain.stderr)
        self.assertGreater(len(plain.stdout.splitlines()), 2)
        return json.loads(result.stdout)

    def test_a_mesh(self):
        told = self.told(self.write("a.obj", SQUARE))
        self.assertEqual((told["kind"], told["vertices"], told["triangles"]), ("mesh", 4, 2))
        self.assertEqual((told["size"], told["objects"]), ([2, 1, 0], ["square"]))

    def test_a_pattern(self):
        told = self.told(self.write("p.json", json.dumps(PATTERN)))
        self.assertEqual((told["kind"], told["stitches"]), ("pattern", 0))
        self.assertEqual(told["panels"][0]["name"], "front")
        self.assertAlmostEqual(told["panels"][0]["size_m"][0], 0.3)

    def test_a_scene_of_a_file_or_built_in(self):
        told = self.told(self.write("s.toml", SCENE))
        self.assertEqual((told["kind"], told["sheets"], told["bodies"]), ("scene", ["rectangle"], ["sphere"]))
        self.assertIn("linen", told["fabrics"])
        self.assertEqual(self.told("builtin:tshirt")["kind"], "scene")

    def test_fabrics_of_a_file_or_built_in(self):
        told = self.told(self.write("f.toml", FABRICS))
        self.assertEqual((told["kind"], told["fabrics"][0]["name"]), ("fabrics", "thin"))
        self.assertEqual(told["fabrics"][0]["areal_density"], 0.05)
        self.assertEqual(self.told("silk")["fabrics"][0]["name"], "silk")

    def test_faults_are_those_of_the_kind(self):
        for name, text, word in [("b.obj", "v 0 0\n", "b.obj:1"), ("b.json", "{", "b.json"),
                                 ("b.toml", "[[sheet]]\ncolour = 1\n", "colour")]:
            result = call("info", self.write(name, text))
            self.assertEqual(result.returncode, 2)
            self.assertIn(word, result.stderr)
        self.assertEqual(call("info", os.path.join(self.folder, "nowhere.h5")).returncode, 2)

    def test_a_file_name_longer_than_file_systems_know_is_refused(self):
        for table in ["[garment]\npattern", "[[sheet]]\nshape = \"mesh\"\nmesh", SCENE + "[[body]]\nmesh"]:
            result = call("check", self.write("long.toml", f'{table} = "{"x" * 5000}"\n'))
            self.assertEqual(result.returncode, 2, result.stderr)
        self.assertEqual(call("info", "x" * 5000).returncode, 2)
        self.assertEqual(call("render", "x" * 5000).returncode, 2)

    def test_a_name_with_a_line_break_is_refused(self):
        scene = SCENE + 'name = "a\\nv 0 0 0"\n'
        result = call("check", self.write("n.toml", scene))
        self.assertEqual(result.returncode, 2)
        self.assertIn("body[0].name", result.stderr)


if __name__ == "__main__":
    unittest.main()
