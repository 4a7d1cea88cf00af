"""Patterns and scenes as other programs and hands write them: they are read, and what is odd in them is said."""
import json
import os
import resource
import subprocess
import tempfile
import unittest

import h5py

PROGRAM = os.environ.get("SELVAGE", "build/selvage")
SQUARE = [[0, 0], [20, 0], [20, 20], [0, 20]]
SHORT = ["--quiet", "--set", "output.picture=false", "--set", "solver.until=0.02"]


def panel(place, vertices=SQUARE, turn=0):
    count = len(vertices)
    return {"translation": place, "rotation": [0, turn, 0], "vertices": vertices,
            "edges": [{"endpoints": [k, (k + 1) % count]} for k in range(count)]}


def pattern(panels, stitches=()):
    stitches = [[{"panel": a, "edge": i}, {"panel": b, "edge": k}] for a, i, b, k in stitches]
    return {"pattern": {"panels": panels, "stitches": stitches}, "properties": {"units_in_meter": 100}}


class InFolder(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)

    def write(self, name, content):
        content = content if isinstance(content, (str, bytes)) else json.dumps(content)
        content = content.encode() if isinstance(content, str) else content
        with open(os.path.join(os.fsencode(self.folder.name), os.fsencode(name)), "wb") as file:
            file.write(content)
        return name

    def call(self, *arguments, code=0, **options):
        done = subprocess.run([os.path.abspath(PROGRAM), *arguments], cwd=self.folder.name, capture_output=True,
                              timeout=100, **options)
        self.assertEqual(done.returncode, code, done.stderr.decode())
        return done.stdout.decode(), done.stderr.decode()

    def garment(self, content, more=""):
        """Writes a pattern and a scene that uses it."""
        self.write("p.json", content)
        return self.write("s.toml", '[garment]\npattern = "p.json"\nresolution = 0.05\n' + more)


class Reading(InFolder):
    def test_a_scene_whose_file_name_is_not_utf8_is_checked_planned_and_draped(self):
        name = self.write(b"h\xe9md.toml", "[[sheet]]\nresolution = 3\n")
        self.assertIn("nothing found", self.call("check", name)[0])
        self.assertIn("h\ufffd.toml: found no such file", self.call("plan", b"h\xe9.toml", code=2)[1])
        self.assertEqual(json.loads(self.call("check", "--json", name)[0])["scene"], "h\ufffdmd")
        self.assertEqual(json.loads(self.call("plan", "--json", name)[0])["scene"], "h\ufffdmd")
        self.call("drape", name, "-o", "out", *SHORT)
        with open(os.path.join(self.folder.name, "out/summary.json"), encoding="utf-8") as file:
            self.assertEqual(json.load(file)["scene"], "h\ufffdmd")

    def test_a_scene_with_a_byte_order_mark_and_lines_that_end_in_cr_is_read(self):
        self.write("s.toml", b"\xef\xbb\xbf# a sheet\r[[sheet]]\rresolution = 3\r[solver]\runtill = 3\r")
        self.assertIn("s.toml:5:1: solver.untill", self.call("plan", "s.toml", code=2)[1])

    def test_a_pattern_nested_very_deep_is_refused_with_its_place(self):
        deep = json.dumps(pattern({"front": panel([0, 0, 0])})).replace("[[0, 0]", "\n[" + 60000 * "[" + 60000 * "]", 1)
        found = self.call("check", self.garment(deep), code=2)[1]
        for word in ("p.json:2:61", "pattern.panels.front.vertices", "64 deep"):
            self.assertIn(word, found)

    def test_sheets_that_together_need_too_much_memory_are_refused_before_one_is_made(self):
        scene = self.write("s.toml", 40 * "[[sheet]]\nresolution = 250\n" + "[solver]\nmemory_limit = 2e8\n")
        limit = 700 << 20
        found = self.call("plan", scene, code=2,
                          preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_AS, (limit, limit)))[1]
        self.assertIn("solver.memory_limit", found)

    def test_a_run_of_more_panels_than_an_attribute_can_name_keeps_their_names(self):
        small = {f"p{k}": {"vertices": [[0, 0], [2, 0], [0, 2]], "translation": [3 * k, 0, 0],
                           "edges": [{"endpoints": e} for e in ([0, 1], [1, 2], [2, 0])]} for k in range(65)}
        scene = self.garment(pattern(small), "copies = 64\ncopy_offset = [0, 0.1, 0]\n[contact]\nself = false\n")
        self.call("drape", scene, "-o", "out", *SHORT)
        with h5py.File(os.path.join(self.folder.name, "out/run.h5")) as file:
            names = file["selvage/panel_names"].asstr()[()]
            self.assertEqual((len(names), names[0], names[-1]), (4160, "p0", "p64_64"))
        self.assertEqual(len(json.loads(self.call("info", "out/run.h5", "--json")[0])["panels"]), 4160)

    def test_fabrics_are_listed_without_values_that_are_none(self):
        listed = self.call("fabrics")[0]
        self.assertNotIn("nan", listed)
        self.assertIn("bending_twist = automatic", listed)


class Examination(InFolder):
    def test_a_panel_drawn_clockwise_whose_neighbour_is_not_is_told_by_check_plan_and_drape(self):
        mirrored = [[-x, y] for x, y in SQUARE]
        panels = {"front": panel([0, 100, 10]), "back": panel([0, 100, -10], mirrored, turn=180)}
        scene = self.garment(pattern(panels, [("front", 1, "back", 3), ("front", 3, "back", 1)]))
        told = [self.call("check", scene, code=2)[0], self.call("plan", scene)[0],
                self.call("drape", scene, "-o", "out", *SHORT, "--set", "seams.max_time=0.02", code=4)[1]]
        for text in told:
            self.assertIn("`front` (drawn counter-clockwise) is sewn mirrored to `back` (drawn clockwise)", text)

    def test_gathers_are_noted_and_sides_that_cannot_be_sewn_refused(self):
        def scene(height):
            small = [[x, y * height / 20] for x, y in SQUARE]
            panels = {"front": panel([0, 100, 10]), "back": panel([20, 100, -10], small, turn=180)}
            return self.garment(pattern(panels, [("front", 1, "back", 3)]))
        self.assertIn("note: seam_length: p.json:1:", self.call("check", scene(10))[0])
        self.assertEqual(json.loads(self.call("plan", scene(10), "--json")[0])["warnings"], [])
        self.assertIn("(5 to 1)", self.call("check", scene(4), code=2)[0])
        for command in (["check"], ["plan"], ["drape", "-o", "out"]):
            found = self.call(*command, scene(0.5), code=2)[1]
            for word in ("stitches[0]", "front.edges[1], 0.2 m long", "back.edges[3], 0.005 m long", "40 to 1"):
                self.assertIn(word, found)


if __name__ == "__main__":
    unittest.main()
