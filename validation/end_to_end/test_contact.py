"""Cloth does not pass through itself: in no frame, on any number of threads, and not after a kill."""
import json
import os
import signal
import subprocess
import tempfile
import time
import unittest

import h5py
import numpy as np

PROGRAM = os.environ.get("SELVAGE", "build/selvage")
SPHERE = ["builtin:sphere", "--set", "sheet.resolution=33", "--set", "solver.until=1"]
LAYERS = """
summary = "Two sheets that fall on a sphere, one on the other."

[[sheet]]
width = 0.3
height = 0.3
resolution = 15
fabric = "cotton"
center = [0, 0, 0.12]

[[sheet]]
width = 0.25
height = 0.25
resolution = 12
fabric = "cotton"
center = [0.02, 0.01, 0.13]
rotation = [0, 0, 20]

[[body]]
shape = "sphere"
radius = 0.1
friction = 0.3

[solver]
until = 0.5
"""
COMMON = ["--quiet", "--set", "output.picture=false", "--set", "output.precision=lossless",
          "--set", "output.checkpoint_interval=0"]
CLOSE = 1e-4   # [m]


def command(folder, scene, threads, *more):
    return [PROGRAM, "drape", *scene, *COMMON, "--threads", str(threads), "-o", folder, *more]


def run(folder, scene, threads=1, *more):
    return subprocess.run(command(folder, scene, threads, *more), capture_output=True, text=True, timeout=240)


def summary(folder):
    with open(os.path.join(folder, "summary.json")) as file:
        return json.load(file)


def frames(folder):
    """Positions per frame [m], and the corners of the faces."""
    with h5py.File(os.path.join(folder, "run.h5"), "r") as file:
        return file["selvage/positions"][()].astype(float), file["selvage/triangles"][()]


def crossings(x, faces, faces_per_block=256):
    """Counts the pairs of an edge and a face without a common corner that meet."""
    edges = np.unique(np.sort(np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]]), axis=1), axis=0)
    p, q = x[edges[:, 0]], x[edges[:, 1]]
    low, high = np.minimum(p, q), np.maximum(p, q)
    count = 0
    for first in range(0, len(faces), faces_per_block):
        block = faces[first:first + faces_per_block]
        corners = x[block]
        near = np.ones((len(edges), len(block)), bool)
        for c in range(3):
            near &= low[:, c, None] <= corners[:, :, c].max(axis=1)
            near &= high[:, c, None] >= corners[:, :, c].min(axis=1)
        e, f = np.nonzero(near)
        apart = (edges[e][:, :, None] != block[f][:, None, :]).all(axis=(1, 2))
        e, f = e[apart], f[apart]
        a, b, c = (corners[f, k] for k in range(3))

        def side(u, v, w, z):
            return np.einsum("ij,ij->i", np.cross(v - u, w - u), z - u)

        through_plane = side(a, b, c, p[e]) * side(a, b, c, q[e]) < 0
        turns = [side(p[e], q[e], u, v) for u, v in [(a, b), (b, c), (c, a)]]
        count += int(np.sum(through_plane & ((np.min(turns, axis=0) > 0) | (np.max(turns, axis=0) < 0))))
    return count


class Contact(unittest.TestCase):
    def setUp(self):
        holder = tempfile.TemporaryDirectory()
        self.addCleanup(holder.cleanup)
        self.root = holder.name
        self.layers = [self.path("layers.toml")]
        with open(self.layers[0], "w") as file:
            file.write(LAYERS)

    def path(self, name, *more):
        return os.path.join(self.root, name, *more)

    def drape(self, name, scene, threads=1):
        result = run(self.path(name), scene, threads)
        self.assertEqual(result.returncode, 0, result.stderr)
        return frames(self.path(name))

    def check_free(self, name, scene):
        positions, faces = self.drape(name, scene)
        self.assertGreater(len(positions), 10)
        self.assertGreater(np.abs(positions[-1] - positions[0]).max(), 0.01, "nothing moved")
        self.assertEqual([crossings(x, faces) for x in positions], [0] * len(positions))
        end = summary(self.path(name))
        self.assertEqual(end["self"]["intersections"], 0)
        self.assertEqual(end["body"]["intersections"], 0)

    def test_the_checker_of_this_test_finds_a_crossing(self):
        x = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0.2, 0.2, -1], [0.3, 0.2, 1], [3, 3, 1]], float)
        faces = np.array([[0, 1, 2], [3, 4, 5]])
        self.assertGreater(crossings(x, faces), 0)
        self.assertEqual(crossings(np.vstack([x[:3], x[3:] + 2]), faces), 0)

    def test_a_sheet_on_a_sphere_has_no_intersection_in_any_frame(self):
        self.check_free("sphere", SPHERE)

    def test_layers_have_no_intersection_in_any_frame(self):
        self.check_free("layers", self.layers)

    def test_runs_with_contact_repeat_bit_by_bit_and_threads_agree(self):
        runs = [("two", 2), ("again", 2), ("one", 1)]
        two, again, one = (self.drape(name, SPHERE, threads)[0] for name, threads in runs)
        np.testing.assert_array_equal(two, again)
        difference = np.abs(two[-1] - one[-1]).max()
        print(f"one thread and two threads differ by {difference:.2e} m at the end")
        self.assertLess(difference, CLOSE)

    def test_without_self_contact_the_plan_says_so(self):
        result = subprocess.run([PROGRAM, "plan", "builtin:sphere", "--json", "--set", "contact.self=false"],
                                capture_output=True, text=True, timeout=60)
        self.assertEqual(result.returncode, 0, result.stderr)
        skipped = {feature["name"]: feature["reason"] for feature in json.loads(result.stdout)["skipped"]}
        for term in ["cloth_contact", "cloth_friction"]:
            self.assertEqual(skipped.get(term), "contact.self is false")
        result = subprocess.run([PROGRAM, "plan", "builtin:sphere", "--json"],
                                capture_output=True, text=True, timeout=60)
        self.assertNotIn("cloth_contact", [feature["name"] for feature in json.loads(result.stdout)["skipped"]])

    def test_the_response_in_use_is_the_only_one_that_runs_and_repeats(self):
        of_response = {"barrier": "body_contact", "exponential": "body_repulsion", "velocity_rule": "velocity_rule"}
        for response, own in of_response.items():
            with self.subTest(response):
                scene = ["builtin:sphere", "--set", "sheet.resolution=13", "--set", "solver.until=0.3",
                         "--set", "contact.response=" + response]
                first, _ = self.drape(response, scene, 2)
                again, _ = self.drape(response + "_again", scene, 2)
                np.testing.assert_array_equal(first, again)
                result = summary(self.path(response))
                skipped = [feature["name"] for feature in result["skipped"]]
                kernels = [kernel["name"] for kernel in result["kernels"]]
                for name in of_response.values():
                    self.assertEqual(name in result["active"], name == own, name)
                    self.assertEqual(name in skipped, name != own, name)
                    self.assertEqual(name in kernels, name == own, name)
                self.assertLess(first[-1][:, 2].min(), first[0][:, 2].min() - 0.1, "it did not fall")
                self.assertGreater(np.linalg.norm(first[-1], axis=1).min(), 0.25, "the sphere did not hold it")

    def test_layers_go_on_after_a_kill_as_if_nothing_had_happened(self):
        """With friction between layers: what it remembers is in the checkpoint."""
        expected, _ = self.drape("reference", self.layers)
        folder = self.path("killed")
        process = subprocess.Popen(command(folder, self.layers, 1),
                                   stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        self.addCleanup(process.wait)
        deadline = time.monotonic() + 120
        remembered = 0
        while remembered == 0 and process.poll() is None and time.monotonic() < deadline:
            time.sleep(0.05)
            try:
                with h5py.File(os.path.join(folder, "checkpoint.h5"), "r") as file:
                    found = []
                    file.visititems(lambda name, item:
                                    found.append(item.size) if name.endswith("pair_friction") else None)
                    remembered = max(found, default=0)
            except OSError:   # it is not there yet, or just being replaced
                continue
        self.assertIsNone(process.poll(), "the run ended before layers had touched")
        process.send_signal(signal.SIGKILL)
        process.wait()
        self.assertGreater(remembered, 0)
        self.assertFalse(os.path.exists(os.path.join(folder, "summary.json")))
        result = run(folder, self.layers, 1, "--resume")
        self.assertEqual(result.returncode, 0, result.stderr)
        positions, _ = frames(folder)
        np.testing.assert_array_equal(positions[-1], expected[-1])


if __name__ == "__main__":
    unittest.main()
