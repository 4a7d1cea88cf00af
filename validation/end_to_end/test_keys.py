"""No key of a scene is without effect: for every key that `selvage schema` lists some plan or run changes with it."""
import concurrent.futures
import copy
import functools
import hashlib
import json
import os
import pathlib
import subprocess
import tempfile
import unittest

import h5py

PROGRAM = os.path.abspath(os.environ.get("SELVAGE", "build/selvage"))

# Files that scenes name ----------------------------------------------


def tetrahedron(size, low=0.0):
    corners = [(0, 0, low), (size, 0, low), (0, size, low), (0, 0, low + size)]
    faces = [(1, 3, 2), (1, 2, 4), (2, 3, 4), (3, 1, 4)]
    return "".join(f"v {x} {y} {z}\n" for x, y, z in corners) + "".join(f"f {a} {b} {c}\n" for a, b, c in faces)


def grid_mesh(side, size):
    points = [(size * i / side, size * j / side, 0.01 * i * i / side) for j in range(side + 1) for i in range(side + 1)]
    texture = [(size * i / side, size * j / side) for j in range(side + 1) for i in range(side + 1)]
    faces = []
    for j in range(side):
        for i in range(side):
            a = j * (side + 1) + i + 1
            faces += [(a, a + 1, a + side + 2), (a, a + side + 2, a + side + 1)]
    return ("".join(f"v {x} {y} {z}\n" for x, y, z in points) + "".join(f"vt {u} {v}\n" for u, v in texture) +
            "".join("f " + " ".join(f"{v}/{v}" for v in face) + "\n" for face in faces))


def panel(x, turn=(0, 0, 0)):
    return {"translation": [x, 0, 100], "rotation": list(turn), "vertices": [[0, 0], [10, 0], [10, 10], [0, 10]],
            "edges": [{"endpoints": [k, (k + 1) % 4]} for k in range(4)]}


def pattern(turn=(0, 0, 0)):
    return json.dumps({"pattern": {"panels": {"left": panel(0, turn), "right": panel(12)},
                                   "stitches": [[{"panel": "left", "edge": 1}, {"panel": "right", "edge": 3}]]},
                       "properties": {"units_in_meter": 100}})


FILES = {"body.obj": tetrahedron(0.2), "inches.obj": tetrahedron(8),
         "taller.obj": tetrahedron(0.2, -0.05), "sheet.obj": grid_mesh(4, 0.2),
         "smaller.obj": grid_mesh(4, 0.15), "pose_1.obj": tetrahedron(0.2), "pose_2.obj": tetrahedron(0.25),
         "other_1.obj": tetrahedron(0.2), "other_2.obj": tetrahedron(0.3), "plain.json": pattern(),
         "turned.json": pattern((20, 30, 40)),
         "loose.obj": "v 0 0 0\nv 0.2 0 0\nv 0 0.2 0\nv 0.2 0 0\nv 0.2 0.2 0\nv 0 0.2 0\nf 1 2 3\nf 4 5 6\n",
         "touching.obj": tetrahedron(0.2) + "v 0 0 0.2\nv 0.1 0 0.3\nv 0 0.1 0.3\nv 0 0 0.4\n"
                         "f 5 7 6\nf 5 6 8\nf 6 7 8\nf 7 5 8\n",
         "near.obj": tetrahedron(0.2) + "".join(f"v {x} {y} {z}\n" for x, y, z in [
            (0.05, 0.05, -0.01), (0.1, 0.05, -0.1), (0.05, 0.1, -0.1), (0, 0.05, -0.1), (0.05, 0, -0.1),
            (0.05, 0.05, -0.2)]) + "".join(
                f"f 5 {a} {b}\nf 10 {b} {a}\n" for a, b in [(6, 7), (7, 8), (8, 9), (9, 6)])}

# Scenes in which keys count ----------------------------------------------

OUTPUT = {"picture": False, "precision": "lossless"}


def scene(*tables, until=0.1, **more):
    """A scene as nested dictionaries; later tables are merged into earlier ones."""
    whole = {"sheet": [{"width": 0.2, "height": 0.2, "resolution": 5, "center": [0, 0, 1]}],
             "solver": {"until": until}, "output": dict(OUTPUT)}
    for table in (*tables, more):
        for name, value in table.items():
            if isinstance(value, dict) and name in whole:
                whole[name] = {**whole[name], **value}
            else:
                whole[name] = value
    return whole


def on_body(shape, **keys):
    """A small sheet just above a body."""
    above = {"mesh": 0.08, "sphere": 0.253, "plane": 0.004, "capsule": 0.253, "cylinder": 0.103, "cone": 0.103,
             "torus": 0.023, "mannequin": 1.9}[shape]
    sheet = {"width": 0.1, "height": 0.1, "resolution": 5, "center": [0.03, 0.03, above]}
    body = {"shape": shape, **keys}
    if shape == "mesh":
        body.setdefault("mesh", "body.obj")
    if shape == "capsule":
        body.setdefault("end", [1, 0, 0])
    return scene(sheet=[sheet], body=[body])


DROP = scene()
STACK = scene(sheet=[{"width": 0.1, "height": 0.1, "resolution": 7, "center": [0, 0, 0.0035]},
                     {"width": 0.1, "height": 0.1, "resolution": 6, "center": [0, 0, 0.006]}],
              body=[{"shape": "plane"}])
SLOPE = on_body("plane", normal=[0.4, 0, 1])
HANG = scene(pins={"sheet": "top_corners"})
REST = scene(pins={"sheet": "top_corners"}, until="equilibrium")
FINE_REST = scene(sheet=[{"width": 0.2, "height": 0.2, "resolution": 25}], pins={"sheet": "top_corners"},
                  until="equilibrium")
ON_SPHERE = scene(sheet=[{"width": 0.5, "height": 0.5, "resolution": 13, "center": [0, 0, 0.26]}],
                  body=[{"shape": "sphere"}], until="equilibrium")
# A small sheet falls beside a large one, which soon rests.
BESIDE = scene(sheet=[{"width": 0.4, "height": 0.4, "resolution": 21, "center": [0, 0, 0.001]},
                      {"width": 0.1, "height": 0.1, "resolution": 6, "center": [1, 0, 0.06], "rotation": [90, 0, 0]}],
               body=[{"shape": "plane"}], until="equilibrium")
EXPLICIT = scene(HANG, solver={"integrator": "velocity_verlet", "step": 0.01})
SEW = {"garment": {"pattern": "plain.json", "resolution": 0.02},
       "solver": {"until": 0.05}, "output": dict(OUTPUT)}
ELASTIC = {**SEW, "garment": {**SEW["garment"], "elastic": [{"panel": "left", "edges": "0"}]}}
ON_PERSON = {**SEW, "body": [{"shape": "mannequin"}], "seams": {"max_time": 0.02}}
ARRANGED = {**ON_PERSON, "garment": {**SEW["garment"], "parts": {"left": "left torso", "right": "right torso"}}}
HELD_PANEL = {**SEW, "pins": {"hold": [{"panel": "left", "group": "corners"}]}}
MOVED_PANEL = {**SEW, "pins": {"motion": [{"panel": "left", "velocity": [0.1, 0, 0]}]}}
TURNED_PANEL = {**SEW, "garment": {"pattern": "turned.json", "resolution": 0.02}}
SLOWLY = {**SEW, "seams": {"force_limit": 0.01}}
BODY_BETWEEN = {**SEW, "body": [{"shape": "mesh", "mesh": "body.obj", "scale": 0.15,
                                 "center": [0.103, -1.021, 0.04]}]}
PARTS_NEAR = {**BODY_BETWEEN, "body": [{**BODY_BETWEEN["body"][0], "mesh": "near.obj"}]}
BUILTIN = {"garment": {"pattern": "builtin:vest", "resolution": 0.1}, "seams": {"max_time": 0.1},
           "solver": {"until": 0.01}, "output": dict(OUTPUT)}
MESH = scene(sheet=[{"shape": "mesh", "mesh": "sheet.obj", "center": [0, 0, 1]}])
WIND = scene(HANG, wind={"velocity": [3, 1, 0]})
GUSTS = scene(HANG, wind={"gust": 2})
MANNEQUIN = on_body("mannequin")
MOVED = on_body("sphere", keyframe=[{"time": 0.2, "translation": [0, 0, 0.05]}])
SEQUENCE = scene(on_body("mesh", sequence="pose_*.obj", sequence_rate=10))
PULLED = scene(**{"pins": {"motion": [{"group": "left_edge", "velocity": [0.1, 0, 0.2]}]}})
TURNED = scene(**{"pins": {"motion": [{"group": "left_edge", "turns": 0.1}]}})
HELD = scene(**{"pins": {"hold": [{"panel": "sheet[0]", "group": "corners"}]}})
PICTURE = scene(sheet=[{"width": 0.2, "height": 0.2, "resolution": 5}],
                output={"picture": True, "picture_width": 64, "picture_samples": 1}, until=0.02)
CLOTH = {"areal_density": 0.2, "thickness": 0.001, "stretch_weft": 200, "stretch_warp": 200, "shear": 20,
         "bending_weft": 1e-5, "bending_warp": 1e-5}


def own(base=None, **keys):
    text = copy.deepcopy(base or HANG)
    for sheet in text["sheet"]:
        sheet["fabric"] = "own"
    text["fabric"] = {"own": {**CLOTH, **keys}}
    return text


CURVED = own(stretch_warp_curve=[[0.001, 0.1], [0.01, 3], [0.1, 50]])
del CURVED["fabric"]["own"]["stretch_warp"]


# For each key: a scene in which it counts, and the value to which it is set there. The key of a repeated table is that
# of the table's first element.
CASES = {
    "": {"summary": (DROP, "another summary"), "parameters": (DROP, ["sheet.fabric"])},
    "garment": {"pattern": (SEW, "turned.json"), "resolution": (SEW, 0.03), "fabric": (SEW, "silk"),
                "size": (BUILTIN, "L"), "up_axis": (SEW, "z"),
                "rotation_order": (TURNED_PANEL, "zyx"),
                "arrange": (ON_PERSON, "always"), "translation": (SEW, [0, 0, 1]), "copies": (SEW, 2),
                "copy_offset": ({**SEW, "garment": {**SEW["garment"], "copies": 2}}, [0, 0, 2])},
    "solver": {"integrator": (HANG, "implicit_euler"), "until": (HANG, 0.2), "step": (HANG, 0.01),
               "unstable_step": (EXPLICIT, "refuse"), "adaptive": (HANG, True),
               "step_error": (scene(HANG, solver={"adaptive": True}), 1e-6), "tolerance": (REST, 1e-6),
               "step_tolerance": (HANG, 1e-4), "energy_tolerance": (TURNED_PANEL, 1),
               "progressive": (FINE_REST, False), "sleep": (BESIDE, False),
               "load_steps": (ON_SPHERE, 2), "max_time": (ON_SPHERE, 0.05), "max_wall": (ON_SPHERE, 1e-3),
               "newton_iterations": (HANG, 1), "linear_iterations": (HANG, 1),
               "preconditioner": (FINE_REST, "block_jacobi"),
               "precision": (HANG, "float"), "threads": (HANG, 1), "gravity": (HANG, [1, 0, -9.81]),
               "frame_rate": (HANG, 60), "memory_limit": (HANG, 1e6)},
    "contact": {"response": (on_body("plane"), "exponential"),
                "restitution": (scene(on_body("plane"), contact={"response": "velocity_rule"}), 0.8),
                "gap": (on_body("plane"), 0.003), "stiffness": (STACK, 50), "body": (on_body("plane"), False),
                "self": (STACK, False)},
    "membrane": {"model": (HANG, "springs"), "scale": (HANG, 2)},
    "bending": {"model": (HANG, "hinge"), "scale": (HANG, 2),
                "hysteresis": (scene(HANG, sheet=[{"width": 0.2, "height": 0.2, "resolution": 5,
                                                  "fabric": "matsudaira_cotton_broad"}]), True)},
    "seams": {"stiffness": (SEW, 1e3), "force_limit": (SEW, 0.5), "stiffening": (SEW, 1), "closed": (SLOWLY, 0.01),
              "max_time": (SLOWLY, 0.02), "thin": (BODY_BETWEEN, 0.5), "room": (PARTS_NEAR, 0)},
    "garment.elastic": {"panel": (ELASTIC, "right"), "edges": (ELASTIC, "0, 2"), "length": (ELASTIC, 0.5),
                        "stiffness": (ELASTIC, 5)},
    "pins": {"sheet": (DROP, "corners"), "vertices": (DROP, "3, 7")},
    "pins.hold": {"panel": (scene(sheet=[{"resolution": 3}, {"resolution": 3, "center": [0, 0, 2]}],
                                  pins={"hold": [{"panel": "sheet[0]", "group": "corners"}]}), "sheet[1]"),
                  "group": (HELD, "top_edge"), "vertices": (HELD, "12"), "edges": (HELD_PANEL, "1")},
    "pins.motion": {"panel": (scene(sheet=[{"resolution": 3}, {"resolution": 3, "center": [0, 0, 2]}], until=0.05,
                                    pins={"motion": [{"velocity": [0, 0, 1]}]}), "sheet[1]"),
                    "group": (PULLED, "center"), "vertices": (PULLED, "12"), "start": (PULLED, 0.05),
                    "end": (PULLED, 0.05), "velocity": (PULLED, [0, 0.1, 0]), "turns": (PULLED, 0.1),
                    "axis": (TURNED, [1, 0, 0]), "point": (TURNED, [0.1, 0, 0]),
                    "edges": (MOVED_PANEL, "1")},
    "wind": {"velocity": (HANG, [0, 3, 0]), "still_air": (HANG, True), "density": (WIND, 1000),
             "normal_coefficient": (WIND, 2), "tangential_coefficient": (WIND, 1), "gust": (HANG, 3),
             "gust_time": (GUSTS, 0.5), "seed": (GUSTS, 2)},
    "output": {"precision": (HANG, "60um"), "frames": (HANG, False), "sewing": (SEW, False),
               "picture": (DROP, True),
               "picture_width": (PICTURE, 80), "picture_samples": (PICTURE, 2),
               "checkpoint_interval": (scene(HANG, output={"keep_checkpoint": True}), 0),
               "keep_checkpoint": (HANG, True)},
    "garment.fabrics": {"left": (SEW, "silk")},
    "garment.parts": {"left": (ARRANGED, "front skirt")},
    "sheet": {"name": (DROP, "towel"), "shape": (DROP, "mesh"), "mesh": (MESH, "smaller.obj"), "width": (DROP, 0.3),
              "height": (DROP, 0.3), "radius": (scene(sheet=[{"shape": "disc", "resolution": 5}]), 0.2),
              "resolution": (DROP, 6), "mesh_family": (DROP, "cross"), "fabric": (DROP, "silk"),
              "unit": (MESH, "inch"), "texture_unit": (MESH, "dm"), "up_axis": (MESH, "y"),
              "weld": (scene(sheet=[{"shape": "mesh", "mesh": "loose.obj"}]), "exact"), "center": (DROP, [0, 0, 2]),
              "rotation": (DROP, [20, 0, 0])},
    "body": {"name": (on_body("plane"), "floor"), "shape": (on_body("cylinder"), "cone"),
             "mesh": (on_body("mesh"), "taller.obj"), "unit": (on_body("mesh", mesh="inches.obj", unit="inch"), "cm"),
             "up_axis": (on_body("mesh"), "x"), "center": (on_body("sphere"), [0, 0, -0.1]),
             "end": (on_body("capsule"), [0, 1, 0]), "normal": (on_body("plane"), [0, 0.1, 1]),
             "rotation": (on_body("mesh"), [0, 0, 30]), "scale": (on_body("mesh"), 0.9),
             "weld": (on_body("mesh", mesh="touching.obj"), "exact"), "close_holes": (on_body("mesh"), 1),
             "radius": (on_body("sphere"), 0.24), "height": (on_body("cone"), 0.09), "tube": (on_body("torus"), 0.01),
             "friction": (SLOPE, 5), "size": (MANNEQUIN, "L"), "figure": (MANNEQUIN, "men"),
             "stature": (MANNEQUIN, 1.6), "bust": (MANNEQUIN, 1.0), "waist": (MANNEQUIN, 0.8), "hips": (MANNEQUIN, 1.1),
             "shoulder_width": (MANNEQUIN, 0.42), "neck": (MANNEQUIN, 0.36), "arm_length": (MANNEQUIN, 0.5),
             "arm_angle": (MANNEQUIN, 60), "interpolation": (MOVED, "smooth"), "sequence": (SEQUENCE, "other_*.obj"),
             "sequence_rate": (SEQUENCE, 5), "sequence_start": (SEQUENCE, 0.05)},
    "body.keyframe": {"time": (MOVED, 0.1), "translation": (MOVED, [0.05, 0, 0]),
                      "rotation": (on_body("mesh", keyframe=[{"time": 0.1}]), [0, 0, 40]),
                      "arm_angle": (on_body("mannequin", keyframe=[{"time": 0.1}]), 60),
                      "mesh": (on_body("mesh", keyframe=[{"time": 0.1}]), "pose_2.obj")},
    "fabric.NAME": {"base": (own(), "silk"), "areal_density": (own(), 0.3), "thickness": (own(STACK), 0.003),
                    "stretch_weft": (own(), 300), "stretch_warp": (own(), 300), "stretch_coupling": (own(), 50),
                    "shear": (own(), 40), "stretch_weft_curve": (own(), [[0.01, 1], [0.1, 30]]),
                    "stretch_warp_curve": (own(), [[0.01, 1], [0.1, 30]]), "shear_curve": (own(), [[0.1, 1], [0.3, 8]]),
                    "curve": (CURVED, "smooth"),
                    "stretch_limit": (own(), 1e-4), "shear_limit": (own(), 1e-3),
                    "stretch_limit_factor": (own(stretch_limit=1e-4), 100), "bending_weft": (own(), 1e-4),
                    "bending_warp": (own(), 1e-4), "bending_coupling": (own(), 5e-6), "bending_twist": (own(), 1e-4),
                    "hysteresis_weft": (own(scene(HANG, bending={"hysteresis": True}), hysteresis_warp=1e-4), 1e-3),
                    "hysteresis_warp": (own(scene(HANG, bending={"hysteresis": True}), hysteresis_weft=1e-4), 1e-3),
                    "friction": (own(SLOPE), 2), "damping": (own(), 5), "source": (own(), "a book")},
}
# What has to change beside the key, since the key cannot stand without it.
ALONG = {("sheet", "shape"): lambda text: text["sheet"].__setitem__(0, {"shape": "mesh", "mesh": "sheet.obj"})}
for number in ["stretch_weft", "stretch_warp", "shear"]:   # which its curve replaces
    ALONG["fabric.NAME", number + "_curve"] = lambda text, number=number: text["fabric"]["own"].pop(number)


def toml(value):
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return json.dumps(value)
    if isinstance(value, list):
        return "[" + ", ".join(toml(item) for item in value) + "]"
    return repr(value)


def toml_text(table, path=""):
    plain, nested = [], []
    for key, value in table.items():
        name = f"{path}.{key}" if path else key
        if isinstance(value, dict):
            nested.append(f"[{name}]\n" + toml_text(value, name))
        elif isinstance(value, list) and value and isinstance(value[0], dict):
            nested += [f"[[{name}]]\n" + toml_text(item, name) for item in value]
        else:
            plain.append(f"{key} = {toml(value)}\n")
    return "".join(plain + nested)


def changed(base, table, key, value):
    text = copy.deepcopy(base)
    if (table, key) in ALONG:
        ALONG[table, key](text)
    at = text
    for part in table.replace("fabric.NAME", "fabric.own").split(".") if table else []:
        at = at.setdefault(part, {})
        if isinstance(at, list):
            at = at[0]
    if at.get(key) != value:
        at[key] = value
    return text


def digest(path):
    return hashlib.sha256(path.read_bytes()).hexdigest() if path.exists() else None


class Keys(unittest.TestCase):
    maxDiff = None

    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.folder.cleanup)
        cls.root = pathlib.Path(cls.folder.name)
        for name, text in FILES.items():
            (cls.root / name).write_text(text)
        schema = subprocess.run([PROGRAM, "schema", "--json"], capture_output=True, text=True, check=True)
        cls.tables = json.loads(schema.stdout)["tables"]

    def write(self, text):
        name = hashlib.sha256(text.encode()).hexdigest()[:16]
        (self.root / f"{name}.toml").write_text(text)
        return name

    @functools.lru_cache(None)
    def plan(self, text):
        name = self.write(text)
        result = subprocess.run([PROGRAM, "plan", f"{name}.toml", "--json"], cwd=self.root, capture_output=True,
                                text=True, timeout=100)
        if result.returncode != 0:
            return result.returncode, result.stderr.replace(name, "scene")
        plan = json.loads(result.stdout.replace(name, "scene"))
        plan.pop("peak_bytes")   # it counts what the planning process itself takes, which varies
        plan["memory"] = [part for part in plan["memory"] if part["name"] != "program_and_model"]
        return 0, plan

    @functools.lru_cache(None)
    def outcome(self, text):
        """What a run leaves, but for times."""
        name = self.write(text)
        folder = pathlib.Path(tempfile.mkdtemp(dir=self.root))   # of its own: two threads may ask for the same text
        result = subprocess.run([PROGRAM, "drape", f"{name}.toml", "-o", folder.name, "--quiet"], cwd=self.root,
                                capture_output=True, text=True, timeout=100)
        errors = result.stderr.replace(folder.name, "folder").replace(name, "scene")
        left = {"code": result.returncode, "errors": errors}
        if (folder / "summary.json").exists():
            summary = json.loads((folder / "summary.json").read_text())
            left["summary"] = {key: summary[key] for key in
                               ["status", "threads", "precision", "steps", "frames", "newton_iterations",
                                "linear_iterations", "integrators", "residual"]}
        for file in ["final.obj", "body.obj", "preview.png"]:
            left[file] = digest(folder / file)
        for file in ["run.h5", "sewing.h5", "checkpoint.h5"]:
            left[file] = (folder / file).exists()
        if left["run.h5"]:
            with h5py.File(folder / "run.h5", "r") as file:
                left["motion"] = hashlib.sha256(file["VTKHDF/Points"][()].tobytes()).hexdigest()
        return left

    def effect(self, table, key):
        """Returns nothing where the key changes something, else a line that says so."""
        base, value = CASES[table][key]
        before, after = toml_text(base), toml_text(changed(base, table, key, value))
        if before == after:
            return f"{table}.{key}: the case changes nothing"
        (code, plan), (changed_code, changed_plan) = self.plan(before), self.plan(after)
        if code != 0:
            return f"{table}.{key}: {plan}"
        if changed_code != 0 and key != "memory_limit":
            return f"{table}.{key}: {changed_plan}"
        if plan != changed_plan or (table, key) == ("output", "checkpoint_interval"):   # which has its own test
            return None
        return f"{table}.{key} has no effect" if self.outcome(before) == self.outcome(after) else None

    def checkpoints(self, text):
        name = self.write(text)
        subprocess.run([PROGRAM, "drape", f"{name}.toml", "-o", name, "--profile"], cwd=self.root, capture_output=True,
                       timeout=100, check=True)
        trace = json.loads((self.root / name / "trace.json").read_text())
        return sum(event.get("name") == "checkpoint" for event in trace["traceEvents"])

    def test_a_plan_tells_the_same_when_it_is_asked_twice(self):
        uncached = type(self).plan.__wrapped__
        for text in toml_text(HANG), toml_text(on_body("mesh")):
            self.assertEqual(uncached(self, text), uncached(self, text))

    def test_shorter_intervals_make_more_checkpoints(self):
        base, value = CASES["output"]["checkpoint_interval"]
        text = toml_text(changed(base, "output", "checkpoint_interval", value))
        self.assertGreater(self.checkpoints(text), self.checkpoints(toml_text(base)))

    def test_every_key_of_the_schema_changes_a_plan_or_a_run(self):
        listed = [(table["name"], key["name"]) for table in self.tables for key in table["keys"]]
        listed.append(("garment.fabrics", "left"))
        self.assertEqual({key for key in listed if key[1] not in CASES.get(key[0], {})}, set(), "keys without a case")
        with concurrent.futures.ThreadPoolExecutor(2) as pool:
            faults = [fault for fault in pool.map(lambda key: self.effect(*key), listed) if fault]
        self.assertEqual(faults, [])

    def refused(self, text, *words, arguments=()):
        name = self.write(text)
        result = subprocess.run([PROGRAM, "plan", f"{name}.toml", *arguments], cwd=self.root, capture_output=True,
                                text=True, timeout=100)
        self.assertEqual(result.returncode, 2, text + result.stdout)
        for word in words:
            self.assertIn(word, result.stderr)

    def test_keys_that_cannot_act_where_they_stand_are_refused(self):
        cases = [(on_body("sphere", scale=2), "body[0].scale", "mesh"),
                 (on_body("sphere", bust=0.9), "body[0].bust", "mannequin"),
                 (on_body("mesh", waist=0.7), "body[0].waist", "mannequin"),
                 (on_body("mesh", radius=0.1), "body[0].radius", "sphere"),
                 (on_body("plane", unit="cm"), "body[0].unit", "mesh"),
                 (on_body("sphere", up_axis="y"), "body[0].up_axis", "mesh"),
                 (on_body("mesh", sequence_rate=10), "body[0].sequence_rate", "sequence"),
                 (on_body("sphere", interpolation="smooth"), "body[0].interpolation", "keyframe"),
                 (own(hysteresis_weft=1e-3), "fabric.own.hysteresis_weft", "bending.hysteresis"),
                 (own(curve="smooth"), "fabric.own.curve", "shear_curve"),
                 (scene(fabric={"coton": dict(CLOTH)}), "fabric.coton", "`cotton`"),
                 (scene(sheet=[{"radius": 0.1}]), "sheet[0].radius", "disc"),
                 (scene(sheet=[{"shape": "mesh", "mesh": "sheet.obj", "mesh_family": "cross"}]), "sheet[0].mesh_family",
                  "rectangle"),
                 (scene(sheet=[{"unit": "cm"}]), "sheet[0].unit", "mesh"),
                 (scene(wind={"seed": 3}), "wind.seed", "wind.gust"),
                 (scene(wind={"density": 1}), "wind.density", "still_air"),
                 (scene(seams={"closed": 0.01}), "seams.closed", "garment"),
                 (scene(solver={"tolerance": 1e-4}), "solver.tolerance", "equilibrium"),
                 (scene(solver={"step_error": 1e-4}), "solver.step_error", "adaptive"),
                 (scene(output={"picture_width": 200}), "output.picture_width", "output.picture")]
        for text, *words in cases:
            with self.subTest(words[0]):
                self.refused(toml_text(text), *words)
        self.refused(toml_text(DROP), "--set sheet.radius=0.3", "disc", arguments=["--set", "sheet.radius=0.3"])

    def test_what_the_command_line_overrules_may_stand_in_the_file(self):
        text = toml_text(scene(sheet=[{"fabric": "own"}], fabric={"own": dict(CLOTH)}, solver={"tolerance": 1e-4},
                               until="equilibrium"))
        name = self.write(text)
        result = subprocess.run([PROGRAM, "drape", f"{name}.toml", "-o", name, "--quiet", "--set", "solver.until=0.05",
                                 "--set", "sheet.fabric=silk", "--set", "sheet.resolution=4"],
                                cwd=self.root, capture_output=True, text=True, timeout=100)
        self.assertEqual(result.returncode, 0, result.stderr)
        with h5py.File(self.root / name / "run.h5", "r") as file:
            told = file["selvage"].attrs["scene_text"]
        told = told.decode() if isinstance(told, bytes) else told
        self.assertNotIn("tolerance", told)
        self.assertNotIn("fabric.own", told)

    def test_a_scene_with_gusts_can_be_asked_for_its_rest_in_the_mean_wind(self):
        gusts = self.write(toml_text(scene(HANG, wind={"velocity": [1, 0, 0], "gust": 2, "seed": 3})))
        plans = [subprocess.run([PROGRAM, "plan", f"{name}.toml", "--json", "--set", "solver.until=equilibrium"],
                                cwd=self.root, capture_output=True, text=True, timeout=100)
                 for name in [gusts, self.write(toml_text(scene(HANG, wind={"velocity": [1, 0, 0]})))]]
        for plan in plans:
            self.assertEqual(plan.returncode, 0, plan.stderr)
            self.assertIn("wind", json.loads(plan.stdout)["active"])
        self.refused(toml_text(scene(REST, wind={"gust": 2})), "wind.gust", "nothing comes to rest")


if __name__ == "__main__":
    unittest.main()
