"""bench scaling and bench skip on small cloths: the shape of what they print and leave."""
import csv
import json
import os
import subprocess
import tempfile
import unittest

PROGRAM = os.environ.get("SELVAGE", "build/selvage")


def bench(suite, *options):
    result = subprocess.run([PROGRAM, "bench", suite, "--json", "--", *options],
                            capture_output=True, text=True, timeout=500)
    assert result.returncode == 0, result.stderr
    return json.loads(result.stdout)


class Scaling(unittest.TestCase):
    def test_each_run_is_a_benchmark_and_exponents_come_from_them(self):
        with tempfile.TemporaryDirectory() as folder:
            report = bench("scaling", "--scene", "hanging", "--min-vertices", "144", "--max-vertices", "576",
                           "--threads", "1", "--output", folder)
            runs = report["benchmarks"]
            self.assertEqual([run["vertices"] for run in runs], [144, 576])
            for run in runs:
                self.assertTrue(run["finished"])
                self.assertLess(run["residual"], 1e-3)
                for key in ["real_time", "wall_s", "peak_memory_bytes", "newton_iterations", "linear_iterations"]:
                    self.assertGreater(run[key], 0, key)
            exponents = report["context"]["growth_exponents"]["hanging, 1 thread"]
            self.assertIsNotNone(exponents["wall_s"])
            self.assertIsNone(exponents["contacts"])
            with open(os.path.join(folder, "scaling.csv")) as file:
                self.assertEqual(len(list(csv.DictReader(file))), 2)
            with open(os.path.join(folder, "scaling.png"), "rb") as file:
                self.assertEqual(file.read(4), b"\x89PNG")


class Skip(unittest.TestCase):
    def test_what_is_absent_is_neither_launched_nor_initialised(self):
        runs = bench("skip", "--resolution", "17", "--repeats", "1", "--until", "0.3")["benchmarks"]
        states = {}
        for run in runs:
            feature, state = run["name"].split("/")
            states.setdefault(feature, {})[state] = run
        self.assertLessEqual({"body", "friction", "embree", "damping", "hysteresis", "curves", "wind",
                              "self-contact", "sleep", "frames", "picture"}, set(states))
        for feature, of in states.items():
            with self.subTest(feature):
                self.assertFalse(of["absent"]["in_use"])
                if "active" in of:
                    self.assertTrue(of["active"]["in_use"])
        self.assertTrue(states["self-contact"]["idle"]["in_use"])   # cloth that could meet itself has to be looked at
        for feature, of in states.items():
            for state, run in of.items():
                with self.subTest(feature, state=state):
                    self.assertEqual(run["embree"], feature == "embree" and state != "absent"
                                     or feature == "picture" and state == "active")
                    self.assertEqual(run["opencv"], feature == "picture" and state == "active")


if __name__ == "__main__":
    unittest.main()
