"""Feeds faulty input to the program: each fault ends with 2 and a message of place, value found and expectation."""
import copy
import json
import os
import re
import resource
import shutil
import subprocess
import unittest

import h5py
import numpy as np

from scratch import Scratch

PROGRAM = os.environ.get("SELVAGE", "build/selvage")
SHORT = ["--quiet", "--threads", "1", "--set", "output.picture=false", "--set", "solver.until=0.02"]
ADDRESS_SPACE = 4 << 30   # a fault that is noticed too late must not take the machine's memory

SHEET = "[[sheet]]\nresolution = 3\n"
MESH_BODY = SHEET + '[[body]]\nname = "solid"\nshape = "mesh"\nmesh = "body.obj"\ncenter = [0, 0, -1]\n'
GARMENT = '[garment]\npattern = "pattern.json"\nresolution = 0.05\n'

SQUARE = [{"endpoints": [0, 1]}, {"endpoints": [1, 2]}, {"endpoints": [2, 3]}, {"endpoints": [3, 0]}]


def panel(depth):
    return {"translation": [0, 100, depth], "rotation": [0, 0, 0],
            "vertices": [[0, 0], [20, 0], [20, 20], [0, 20]], "edges": copy.deepcopy(SQUARE)}


PATTERN = {"pattern": {"panels": {"front": panel(10), "back": panel(-10)},
                       "stitches": [[{"panel": "front", "edge": 1}, {"panel": "back", "edge": 1}]]},
           "properties": {"units_in_meter": 100, "curvature_coords": "relative"}}


# Faults of the pattern above.
def open_outline(panels, stitches, whole):
    panels["front"]["edges"].pop(2)


def wrong_endpoint(panels, stitches, whole):
    panels["front"]["edges"][2]["endpoints"] = [2, 9]


def crossing_outline(panels, stitches, whole):
    panels["front"]["vertices"] = [[0, 0], [20, 20], [20, 0], [0, 30]]


def zero_area(panels, stitches, whole):
    panels["front"]["vertices"] = [[0, 0], [10, 0], [20, 0], [30, 0]]


def coincident_ends(panels, stitches, whole):
    panels["front"]["vertices"][1] = [0, 0]


def edge_in_two_stitches(panels, stitches, whole):
    stitches.append([{"panel": "front", "edge": 1}, {"panel": "back", "edge": 3}])


def missing_panel(panels, stitches, whole):
    stitches[0][1]["panel"] = "bakc"


def missing_edge(panels, stitches, whole):
    stitches[0][0]["edge"] = 7


def one_sided_stitch(panels, stitches, whole):
    stitches[0].pop()


def no_panels(panels, stitches, whole):
    panels.clear()
    stitches.clear()


def no_pattern(panels, stitches, whole):
    del whole["pattern"]


def text_for_number(panels, stitches, whole):
    panels["back"]["vertices"][2][0] = "wide"


def bad_translation(panels, stitches, whole):
    panels["back"]["translation"] = [0, 0]


def bad_unit(panels, stitches, whole):
    whole["properties"]["units_in_meter"] = 0


def unknown_curve(panels, stitches, whole):
    panels["front"]["edges"][0]["curvature"] = {"type": "spiral", "params": [[0.5, 0.1]]}


CORNERS = ["v 0 0 0", "v 1 0 0", "v 0 1 0", "v 0 0 1"]
SIDES = ["f 1 3 2", "f 1 2 4", "f 1 4 3", "f 2 3 4"]


def obj(corners=None, sides=None):
    return "\n".join((corners or CORNERS) + (sides or SIDES)) + "\n"


def run(*arguments, seconds=60):
    def limit_memory():
        resource.setrlimit(resource.RLIMIT_AS, (ADDRESS_SPACE, ADDRESS_SPACE))

    return subprocess.run([PROGRAM, *arguments], capture_output=True, text=True, timeout=seconds,
                          preexec_fn=limit_memory)


class BadInput(Scratch):
    def drape(self, scene, *more, seconds=60):
        shutil.rmtree(self.path("out"), ignore_errors=True)
        return run("drape", scene, "-o", self.path("out"), *SHORT, *more, seconds=seconds)

    def assert_refused(self, result, *words):
        """words: the file or key, the value found, and whatever else the message must tell."""
        self.assertEqual(result.returncode, 2, result.stderr)
        self.assertIn("expected", result.stderr)
        self.assertEqual(result.stdout, "")
        for word in words:
            self.assertRegex(result.stderr, re.compile(word, re.IGNORECASE))
        for trace in ["std::", "terminate", "internal error", "Assertion", "Traceback"]:
            self.assertNotIn(trace, result.stderr)
        self.assertFalse(os.path.exists(self.path("out/run.h5")), "a refused run left run.h5")

    def assert_scene_refused(self, text, *words):
        self.assert_refused(self.drape(self.write("scene.toml", text)), *words)

    def assert_pattern_refused(self, change, *words):
        pattern = copy.deepcopy(PATTERN)
        change(pattern["pattern"]["panels"], pattern["pattern"]["stitches"], pattern)
        self.write("pattern.json", json.dumps(pattern))
        self.assert_scene_refused(GARMENT, r"pattern\.json", *words)

    def assert_body_refused(self, text, *words):
        self.write("body.obj", text)
        self.assert_scene_refused(MESH_BODY, r"body\.obj", *words)


class Control(BadInput):
    """Without a fault the same inputs are accepted, so the refusals below come from the fault."""

    def test_sound_inputs_run(self):
        self.write("pattern.json", json.dumps(PATTERN))
        self.write("body.obj", obj())
        for text in [SHEET, MESH_BODY, GARMENT]:
            with self.subTest(text):
                result = run("plan", self.write("scene.toml", text))
                self.assertEqual(result.returncode, 0, result.stderr)
        result = self.drape(self.write("scene.toml", MESH_BODY))
        self.assertEqual(result.returncode, 0, result.stderr)


class BadSceneFiles(BadInput):
    def test_faults_of_a_scene_file(self):
        for text, *words in [
            ("", "scene.toml", "garment.*sheet"),
            (SHEET + "[sovler]\nstep = 0.01\n", r"scene\.toml:3:", "sovler", "did you mean `solver`"),
            (SHEET + "[solver]\nstpe = 0.01\n", r"scene\.toml:4:", "stpe", "did you mean `step`"),
            (SHEET + '[solver]\nstep = "fast"\n', r"scene\.toml:4:", r"solver\.step", "fast", "number"),
            (SHEET + "[solver]\nlinear_iterations = 2.5\n", r"solver\.linear_iterations", r"2\.5", "integer|whole"),
            (SHEET + "[solver]\ngravity = [0, -9.81]\n", r"solver\.gravity", "three numbers"),
            (SHEET + "[solver]\nstep = -0.01\n", r"scene\.toml:4:", r"solver\.step", r"-0\.01"),
            (SHEET + "[solver]\nstep = nan\n", r"scene\.toml:4:", r"solver\.step", "nan"),
            (SHEET + "[wind]\nvelocity = [inf, 0, 0]\n", r"scene\.toml:4:", r"wind\.velocity", "inf"),
            (SHEET + "[solver\nstep = 1\n", r"scene\.toml:3:", "valid TOML"),
            (SHEET + "resolution = 4\n", r"scene\.toml:3:", "resolution"),
            ("[[sheet]]\nresolution = 1\n", r"sheet\[0\]\.resolution", "found 1"),
            ("[[sheet]]\nshape = \"triangle\"\n", r"sheet\[0\]\.shape", "triangle", "rectangle"),
            ("[[sheet]]\nwidth = 0\n", r"sheet\[0\]\.width", "found 0"),
            ("[[sheet]]\nfabric = \"coton\"\n", r"sheet\[0\]\.fabric", "coton", "did you mean `cotton`"),
            (SHEET + 'fabric = "mine"\n[fabric.mine]\nbase = "cotton"\nstretch_weft = -5\n',
             r"fabric\.mine\.stretch_weft", "-5"),
            (SHEET + 'fabric = "mine"\n[fabric.mine]\nareal_density = 0.2\n', r"fabric\.mine", "nothing"),
            (SHEET + 'fabric = "mine"\n[fabric.mine]\nbase = "cotton"\nareal_density = 150\n',
             r"fabric\.mine\.areal_density", "150", "kg/m"),
            (SHEET + 'fabric = "mine"\n[fabric.mine]\nbase = "cotton"\nstretch_coupling = 1e7\n',
             r"fabric\.mine\.stretch_coupling", "1e\\+?0?7"),
            (SHEET + "[solver]\nmemory_limit = 1000\n", "resolution", "memory_limit"),
            (SHEET + '[pins]\nvertices = "0, 9"\n', r"pins\.vertices", "9"),
            (SHEET + '[pins]\nvertices = "first"\n', r"pins\.vertices", "first"),
            (SHEET + '[[body]]\nshape = "mesh"\n', r"body\[0\]\.mesh", "no file name"),
            (SHEET + '[[body]]\nshape = "mesh"\nmesh = "none.obj"\n', r"body\[0\]\.mesh", r"none\.obj"),
            (SHEET + '[[body]]\nshape = "plane"\nnormal = [0, 0, 0]\n', r"body\[0\]\.normal", "direction"),
            (SHEET + '[[body]]\nshape = "torus"\nradius = 0.1\ntube = 0.2\n', r"body\[0\]\.tube", r"0\.2 m", r"0\.1 m"),
            (SHEET + '[[body]]\nshape = "sphere"\n[[body.keyframe]]\ntranslation = [0, 0, 1]\n',
             r"body\[0\]\.keyframe\[0\]\.time", "0 s", "above 0 s"),
            (SHEET + '[[body]]\nshape = "sphere"\n[[body.keyframe]]\ntime = 2\n[[body.keyframe]]\ntime = 1\n',
             r"body\[0\]\.keyframe\[1\]\.time", "1 s", "above 2 s"),
            (SHEET + '[[body]]\nshape = "sphere"\n[[body.keyframe]]\ntime = 1\nmove = [0, 0, 1]\n',
             r"body\[0\]\.keyframe\[0\]\.move", "unknown key"),
            (SHEET + '[[body]]\nshape = "sphere"\n[[body.keyframe]]\ntime = 1\narm_angle = 10\n',
             r"body\[0\]\.keyframe\[0\]\.arm_angle", "sphere", "mannequin"),
            (SHEET + '[[body]]\nshape = "sphere"\n[[body.keyframe]]\ntime = 1\nmesh = "a.obj"\n',
             r"body\[0\]\.keyframe\[0\]\.mesh", r"a\.obj"),
            (SHEET + '[[body]]\nshape = "sphere"\nsequence = "a_*.obj"\n', r"body\[0\]\.sequence", "sphere"),
            (SHEET + '[[body]]\nshape = "mesh"\nsequence = "a_*.obj"\n', r"body\[0\]\.sequence", r"a_\*\.obj"),
            (SHEET + '[[body]]\nshape = "mesh"\nsequence = "a.obj"\n', r"body\[0\]\.sequence", r"one \*"),
            (SHEET + '[[pins.motion]]\nend = 0\n', r"pins\.motion\[0\]\.end", "0 s", "start"),
            (SHEET + '[[pins.motion]]\nturns = 1\naxis = [0, 0, 0]\n', r"pins\.motion\[0\]\.axis", "direction"),
            (SHEET + '[[pins.motion]]\ngroup = "middle"\n', r"pins\.motion\[0\]\.group", "middle", "center"),
            (SHEET + '[[pins.motion]]\n[solver]\nintegrator = "rk4"\n', r"solver\.integrator", "rk4", "bdf2"),
            (SHEET + '[[pins.motion]]\n[solver]\nload_steps = 3\n', r"solver\.load_steps", "3", "moves"),
            (SHEET + '[[body]]\nshape = "sphere"\nradius = -1\n', r"body\[0\]\.radius", "-1"),
            (SHEET + '[[body]]\nshape = "mannequin"\nstature = 170\n', r"body\[0\]\.stature", "170", "m"),
            (SHEET + '[[body]]\nshape = "mannequin"\nbust = 1.9\n', r"body\[0\]\.bust", r"1\.9"),
            (SHEET + '[[body]]\nshape = "mannequin"\nsize = "huge"\n', r"body\[0\]\.size", "huge", '"S", "M"'),
            ('[garment]\npattern = "none.json"\n', r"garment\.pattern", r"none\.json"),
            ('[garment]\npattern = "builtin:tshrt"\n', "builtin:|pattern", "tshrt", "tshirt"),
            ('[garment]\npattern = "builtin:vest"\n[garment.fabrics]\nfrnt = "silk"\n',
             r"garment\.fabrics", "frnt", "did you mean `front`"),
        ]:
            with self.subTest(text):
                self.assert_scene_refused(text, *words)

    def test_a_scene_file_that_is_not_text(self):
        with open(self.path("scene.toml"), "wb") as file:
            file.write(bytes(range(256)))
        self.assert_refused(self.drape(self.path("scene.toml")), r"scene\.toml")

    def test_places_that_hold_no_scene(self):
        self.assert_refused(self.drape(self.path("none.toml")), r"none\.toml", "no such file")
        self.assert_refused(self.drape(self.folder), re.escape(self.folder))
        self.assert_refused(self.drape("builtin:shpere"), "shpere", "did you mean `sphere`")


class BadCommandLines(BadInput):
    def test_faulty_overrides(self):
        for scene, override, *words in [
            ("builtin:sphere", "solver.step", "found `solver.step`", "table.key=value"),
            ("builtin:sphere", "=1", "table.key=value"),
            ("builtin:sphere", "solver.step=", r"solver\.step"),
            ("builtin:sphere", "solvr.step=1", "solvr", "did you mean `solver"),
            ("builtin:sphere", "sheet.resolution=many", r"sheet.*resolution", "many"),
            ("builtin:sphere", "sheet.resolution=1e9", r"sheet.*resolution", "1e\\+?0?9|1000000000"),
            ("builtin:sphere", "sheet[3].resolution=9", r"sheet\[3\]"),
            ("builtin:tshirt", "garment.resolution=10", r"garment\.resolution", "found 10"),
            ("builtin:tshirt", "garment.fabric=lether", r"garment\.fabric", "lether"),
            ("builtin:sphere", "solver.until=never", r"solver\.until", "never", "equilibrium"),
            ("builtin:sphere", "solver.until=nan", r"solver\.until", "nan"),
            ("builtin:sphere", "solver.until=-1", r"solver\.until", "-1"),
            ("builtin:sphere", "solver.precision=half", r"solver\.precision", "half", "float"),
            ("builtin:sphere", "contact.gap=2", r"contact\.gap", "found 2"),
            ("builtin:sphere", "contact.response=exponental", r"contact\.response", "did you mean `?\"?exponential"),
            ("builtin:sphere", "contact.restitution=0.5", r"contact\.restitution", "found 0.5", "barrier"),
        ]:
            with self.subTest(override):
                self.assert_refused(self.drape(scene, "--set", override), *words)

    def test_what_the_velocity_rule_has_no_place_for_is_refused(self):
        for scene, override, *words in [
            ("builtin:sphere", "contact.restitution=1.5", r"contact\.restitution", "found 1.5"),
            ("builtin:sphere", "contact.stiffness=200", r"contact\.stiffness", "velocity_rule"),
            ("builtin:sphere", "contact.self=true", r"contact\.self", "velocity_rule"),
            ("builtin:sphere", "solver.until=equilibrium", r"solver\.until", "velocity_rule"),
            ("builtin:stress_squeeze", "solver.until=1", r"body\[0\]", "velocity_rule"),
        ]:
            with self.subTest(override):
                result = self.drape(scene, "--set", "contact.response=velocity_rule", "--set", override)
                self.assert_refused(result, *words)

    def test_bad_usage_ends_with_2(self):
        for arguments, word in [
            (["drape", "--no-such-option"], "--no-such-option"),
            (["drape", "builtin:sphere", "another.toml"], "another.toml"),
            (["drape", "builtin:sphere", "--threads", "many"], "many"),
            (["drape", "builtin:sphere", "--threads", "-1"], "-1"),
            (["drape", "builtin:sphere", "--precision", "half"], "half"),
            (["drape", "builtin:sphere", "--set"], "--set"),
            (["undrape"], "undrape"),
            ([], ""),
        ]:
            with self.subTest(arguments):
                result = run(*arguments)
                self.assertEqual(result.returncode, 2, result.stderr)
                self.assertIn(word, result.stderr)
                self.assertNotIn("internal error", result.stderr)

    def test_a_resolution_beyond_the_memory_is_refused_before_it_is_used(self):
        for scene, override in [("builtin:tshirt", "garment.resolution=1e-4"),
                                ("builtin:sphere", "sheet.resolution=4097"),
                                ("builtin:cusick", "sheet.resolution=4097")]:
            with self.subTest(override):
                try:
                    result = self.drape(scene, "--set", override, "--set", "solver.memory_limit=1e9", seconds=20)
                except subprocess.TimeoutExpired:
                    self.fail("no answer within 20 s")
                self.assert_refused(result, "resolution")


class BadOutput(BadInput):
    SCENE = ["builtin:sphere", "--set", "sheet.resolution=3", *SHORT]

    def assert_folder_refused(self, folder):
        result = run("drape", *self.SCENE, "-o", folder)
        self.assertEqual(result.returncode, 2, result.stderr)
        self.assertIn("expected", result.stderr)
        self.assertNotIn("internal error", result.stderr)

    def test_folders_that_cannot_be_written(self):
        for folder in [self.write("a_file", ""), self.write("b_file", "") + "/sub", "/proc/no/such", "/proc/1", ""]:
            with self.subTest(folder):
                self.assert_folder_refused(folder)

    def test_a_folder_whose_files_cannot_be_replaced(self):
        os.makedirs(self.path("out/run.h5/occupied"))
        self.assert_folder_refused(self.path("out"))

    def test_resume_with_a_damaged_checkpoint(self):
        os.mkdir(self.path("out"))
        self.write("out/checkpoint.h5", "this is not HDF5")
        result = run("drape", *self.SCENE, "-o", self.path("out"), "--resume")
        self.assert_refused(result, r"checkpoint\.h5")

    def test_resume_with_parts_of_the_state_missing(self):
        def drop(name):
            with h5py.File(self.path("out/checkpoint.h5"), "r+") as file:
                found = []
                file.visit(lambda path: found.append(path) if path.split("/")[-1] == name else None)
                del file[found[0]]

        def shorten(name):
            with h5py.File(self.path("out/checkpoint.h5"), "r+") as file:
                found = []
                file.visit(lambda path: found.append(path) if path.split("/")[-1] == name else None)
                short = file[found[0]][:1]
                del file[found[0]]
                file[found[0]] = short

        def swap_in_another_file():
            os.replace(self.path("out/run.h5"), self.path("out/checkpoint.h5"))

        def cut():
            os.truncate(self.path("out/checkpoint.h5"), os.path.getsize(self.path("out/checkpoint.h5")) // 2)

        scene = [*self.SCENE, "-o", self.path("out"), "--set", "output.keep_checkpoint=true"]
        for name, damage, word in [
            ("no positions", lambda: drop("pos"), r"checkpoint\.h5"),
            ("no counters", lambda: drop("counters.steps"), r"checkpoint\.h5"),
            ("no time", lambda: drop("time"), r"checkpoint\.h5"),
            ("short velocities", lambda: shorten("vel"), r"checkpoint\.h5"),
            ("another file", swap_in_another_file, r"checkpoint\.h5"),
            ("half a file", cut, r"checkpoint\.h5"),
            ("no trajectory", lambda: os.remove(self.path("out/run.h5")), r"run\.h5"),
        ]:
            with self.subTest(name):
                self.assertEqual(run("drape", *scene).returncode, 0)
                damage()
                result = run("drape", *scene, "--resume")
                self.assertEqual(result.returncode, 2, result.stderr)
                self.assertRegex(result.stderr, word)
                self.assertIn("expected", result.stderr)


class BadPatterns(BadInput):
    def test_faults_of_a_pattern(self):
        for change, *words in [
            (open_outline, "front", "edges"),
            (wrong_endpoint, r"front\.edges\[2\]", "9"),
            (crossing_outline, r"front", "cross"),
            (zero_area, "front", "area"),
            (coincident_ends, r"front\.edges\[0\]"),
            (edge_in_two_stitches, r"stitches\[1\]", "front", r"stitches\[0\]"),
            (missing_panel, r"stitches\[0\]", "bakc", "did you mean `back`"),
            (missing_edge, r"stitches\[0\]", "7"),
            (one_sided_stitch, r"stitches\[0\]"),
            (no_panels, "panels"),
            (no_pattern, "pattern"),
            (text_for_number, r"back\.vertices\[2\]", "wide"),
            (bad_translation, r"back\.translation", "three|3"),
            (bad_unit, "units_in_meter", "0"),
            (unknown_curve, r"front\.edges\[0\]", "spiral", "quadratic"),
        ]:
            with self.subTest(change.__name__):
                self.assert_pattern_refused(change, *words)

    def test_a_pattern_in_metres_read_as_centimetres(self):
        def metres(panels, stitches, whole):
            for each in panels.values():
                each["vertices"] = [[x / 100, y / 100] for x, y in each["vertices"]]

        self.assert_pattern_refused(metres, "units_in_meter")

    def test_text_that_is_not_json(self):
        self.write("pattern.json", '{"pattern": {"panels": [}}')
        self.assert_scene_refused(GARMENT, r"pattern\.json:1:", "valid JSON")

    def test_an_empty_file(self):
        self.write("pattern.json", "")
        self.assert_scene_refused(GARMENT, r"pattern\.json", "valid JSON")

    def test_nesting_as_deep_as_the_file_is_long(self):
        self.write("pattern.json", "[" * 200000)
        self.assert_scene_refused(GARMENT, r"pattern\.json")


class BadBodies(BadInput):
    def test_faults_of_a_body_mesh(self):
        far_corners = ["v 0 0 0", "v 1000 0 0", "v 0 1000 0", "v 0 0 1700"]
        for name, text, *words in [
            ("hole", obj(sides=SIDES[:3]), "hole", "closed"),
            ("not a number", obj(corners=["v nan 0 0"] + CORNERS[1:]), ":1", "nan"),
            ("infinite", obj(corners=["v 0 inf 0"] + CORNERS[1:]), ":1", "inf"),
            ("word", obj(corners=["v zero 0 0"] + CORNERS[1:]), ":1", "zero"),
            ("two numbers", obj(corners=["v 0 0"] + CORNERS[1:]), ":1"),
            ("index beyond the end", obj(sides=SIDES[:3] + ["f 2 3 9"]), ":8", "9"),
            ("index 0", obj(sides=SIDES[:3] + ["f 0 3 4"]), ":8", "0"),
            ("index before the start", obj(sides=SIDES[:3] + ["f -9 3 4"]), ":8", "-9"),
            ("two corners", obj(sides=SIDES[:3] + ["f 2 3"]), ":8"),
            ("zero area", obj(sides=SIDES + ["f 1 1 2"]), "area|twice|corner"),
            ("zero area by position", obj(corners=CORNERS[:3] + ["v 0 0 0"]), "area"),
            ("no faces", "\n".join(CORNERS), "face"),
            ("empty", "", "face"),
            ("one face turned", obj(sides=SIDES[:3] + ["f 4 3 2"]), "disagree|outside"),
            ("millimetres read as metres", obj(corners=far_corners), "1700|measures", "mm"),
            ("binary", "\x00\x01\x02\x7f" * 64, ":1|face"),
        ]:
            with self.subTest(name):
                self.assert_body_refused(text, *words)

    def test_a_body_that_is_inside_out_is_turned(self):
        self.write("body.obj", obj(sides=["f 2 3 1", "f 4 2 1", "f 3 4 1", "f 4 3 2"]))
        result = self.drape(self.write("scene.toml", MESH_BODY))
        self.assertEqual(result.returncode, 0, result.stderr)
        with open(self.path("out/body.obj")) as file:
            words = [line.split() for line in file]
        corners = np.array([[float(x) for x in w[1:]] for w in words if w[0] == "v"])
        faces = np.array([[int(x.split("/")[0]) - 1 for x in w[1:]] for w in words if w[0] == "f"])
        a, b, c = (corners[faces[:, k]] for k in range(3))
        self.assertGreater(np.sum(a * np.cross(b, c)) / 6, 0.1)


if __name__ == "__main__":
    unittest.main()
